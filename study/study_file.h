#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/place.h"
#include "common/core/result.h"
#include "study/answer_posterior.h"
#include "study/track.h"

/// A study as its author writes it: message Study of proto/config.proto.
namespace palp::study {

/// By what a participant is to answer.
enum class Feedback : std::uint8_t {
  Force,  ///< the hand is given it
  None,   ///< the hand is given none, and nothing is shown
  Drawn,  ///< the hand is given none; what the tip measures is drawn
  Both,   ///< given and drawn
  Depth,  ///< the hand is given none; what the estimator of the depth says is shown
};
[[nodiscard]] constexpr bool gives_force(Feedback feedback) noexcept {
  return feedback == Feedback::Force || feedback == Feedback::Both;
}
[[nodiscard]] constexpr bool draws_force(Feedback feedback) noexcept {
  return feedback == Feedback::Drawn || feedback == Feedback::Both;
}

/// What the hand meets; all intervals of a trial are felt under it.
struct Condition {
  std::string name{};
  std::string coupling{};
  std::string up{};    ///< text of the message Impairment
  std::string down{};  ///< likewise
  std::string grip{};
  Feedback feedback{Feedback::Force};
  int taps{3};     ///< of an interval, 1 to 8
  int unjudged{};  ///< of them, the first ones, by which an observer that feels does not judge
};

/// Practice before each condition: ends once `right` of the last `of` are right.
struct Practice {
  double level{1};  ///< [as levels]
  std::size_t right{8};
  std::size_t of{10};
  std::size_t trials_max{30};  ///< who needs more is excluded
};

/// What a trial asks.
enum class StudyTask : std::uint8_t {
  Stiffness,  ///< which is the stiffest?
  Bias,       ///< is the second, felt under the condition, stiffer than the first?
  Detect2,    ///< over which place does something hard lie?
  Detect,     ///< is there something hard?
  Rank,       ///< in which order are three places stiffer, or balls less deep?
  Delay,      ///< which place answered late?
  Locate,     ///< where in an area does something hard lie?
};

/// A ball in the tissue, and how much stiffer it makes the place above it.
struct BallDepth {
  double depth{};     ///< [m], of its top
  double contrast{};  ///< [-], ln of the stiffness over that beside it
};

/// The ball whose depths are asked for.
struct StudyBall {
  double radius{};  ///< [m]
  double ratio{};   ///< [-], its stiffness over the block's
};

/// Where a ball is searched for.
struct SearchArea {
  double side{};    ///< [m], of a square; the ball's axis is anywhere in it
  double within{};  ///< [m], of the axis: found
  double limit{};   ///< [s]
};

/// Who approved of a study.
struct Approval {
  std::string body{};  ///< empty: a pilot
  std::string number{};
};

/// What a participant is asked, how often, and what is done with the answers.
struct Study {
  std::string name{};
  std::string question{};
  std::string instructions{};
  std::string primary{};  ///< the comparison that decides
  Approval ethics{};
  std::uint64_t seed{1};
  std::size_t participants{16};
  StudyTask asks{StudyTask::Stiffness};
  Task task{};
  Method method{};
  std::size_t trials{60};  ///< of a participant in a condition, without catch trials
  std::size_t tracks{2};
  double catch_share{};  ///< [-], over the others
  double rest{60};       ///< [s], between two conditions
  double travel{1.5};    ///< [s], to each place, of persons
  /// [-], or delays [ms]; of depths: 0 if yes or no, and the contrasts.
  std::vector<double> levels{};
  std::vector<BallDepth> depths{};  ///< the deepest first
  /// With depths: the tissue is that of such a ball; nothing: plain tissue made stiffer.
  std::optional<StudyBall> ball{};
  SearchArea search{};  ///< StudyTask::Locate
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

/// The depth [m] of that contrast: between those of the study ln contrast changes evenly with
/// depth. Nothing beyond the least and the greatest.
[[nodiscard]] std::optional<double> depth_of(const Study& study, double contrast) noexcept;

/// With depths: the depth [m] where two intervals are told apart 3 of 4 times, or d' is 1, or a
/// search finds half of what guessing does not, of an observer with that JND; of a ranking the
/// depth of the least deep ball of three that are in order half of the time after chance. Nothing:
/// it lies beyond the study's depths.
[[nodiscard]] std::optional<double> depth_found(const Study& study, double jnd) noexcept;

/// A ranking of balls: the contrast of the one in the middle.
[[nodiscard]] double middle_contrast(const Study& study) noexcept;

/// As the study file has it: "stiffness".
[[nodiscard]] std::string_view task_name(const Study& study) noexcept;

/// Anywhere in the area of a search, from its middle [m]: two numbers of the stream, from `index`
/// on.
[[nodiscard]] Place drawn_place(const SearchArea& area,
                                std::uint64_t seed,
                                std::uint64_t stream,
                                std::uint64_t index) noexcept;

/// The grid on which the tracks of a study, and its fits, hold what they believe.
[[nodiscard]] AnswerTable table_of(const Study& study);

}  // namespace palp::study
