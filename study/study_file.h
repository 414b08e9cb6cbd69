#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "study/answer_posterior.h"
#include "study/track.h"

/// A study as its author writes it: message Study of proto/config.proto.
namespace palp::study {

/// What the hand meets; both intervals of a trial are felt under it.
struct Condition {
  std::string name{};
  std::string coupling{};
  std::string up{};    ///< text of the message Impairment
  std::string down{};  ///< likewise
  std::string grip{};
  bool force{true};  ///< false: the hand is given none
  int taps{3};       ///< of an interval, 1 to 8
};

/// Practice before each condition: ends once `right` of the last `of` are right.
struct Practice {
  double level{1};  ///< [-]
  std::size_t right{8};
  std::size_t of{10};
  std::size_t trials_max{30};  ///< who needs more is excluded
};

/// What a participant is asked, how often, and what is done with the answers.
struct Study {
  std::string name{};
  std::string question{};
  std::string instructions{};
  std::string primary{};      ///< the comparison that decides
  std::string ethics_body{};  ///< empty: a pilot
  std::string ethics_number{};
  std::uint64_t seed{1};
  std::size_t participants{16};
  Task task{};
  Method method{};
  std::size_t trials{60};  ///< of a participant in a condition, without catch trials
  std::size_t tracks{2};
  double catch_share{};          ///< [-], over the others
  double rest{60};               ///< [s], between two conditions
  std::vector<double> levels{};  ///< [-]
  Practice practice{};
  double margin{0.15};          ///< [-], of ln JND
  double catch_right_min{0.8};  ///< [-], share
  double ratio_expected{1.25};  ///< [-], of JNDs
  double sd_expected{0.35};     ///< [-], of differences of ln JND
  std::vector<Condition> conditions{};
};

inline constexpr std::size_t kConditionsMax = 6;  ///< codes A to F

/// Of a text in protobuf's format. `name` is what the sentences call it. Pure.
[[nodiscard]] Result<Study> parse_study(std::string_view text, const std::string& name);

/// "stiffness" or "bias".
[[nodiscard]] std::string_view task_name(const Study& study) noexcept;

/// The grid on which the tracks of a study, and its fits, hold what they believe.
[[nodiscard]] AnswerTable table_of(const Study& study);

}  // namespace palp::study
