#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "study/answer_posterior.h"

/// Methods that choose the level of the next trial from the answers so far.
namespace palp::study {

enum class MethodKind : std::uint8_t {
  Constant,   ///< every level equally often, in an order drawn by seed
  Staircase,  ///< down after n right answers, up after a wrong one
  Quest,      ///< a fixed number of JNDs above 0, JND as believed now (Watson and Pelli 1983)
  QuestPlus,  ///< the level whose answer is expected to tell most (Watson 2017, Prins 2013)
};

inline constexpr std::array kMethods{
    MethodKind::Constant, MethodKind::Staircase, MethodKind::Quest, MethodKind::QuestPlus};

[[nodiscard]] constexpr std::string_view to_string(MethodKind kind) noexcept {
  switch (kind) {
    case MethodKind::Constant:
      return "constant";
    case MethodKind::Staircase:
      return "staircase";
    case MethodKind::Quest:
      return "quest";
    case MethodKind::QuestPlus:
      return "quest-plus";
  }
  return "?";
}

/// Weighted up and down, of logarithms of levels. With equal steps a staircase settles at
/// 2^(-1/n) of right answers in theory only; with these ratios it does so whatever the step
/// (Garcia-Perez 1998): 80.35 % for n = 2, 83.15 % for n = 3.
struct StaircaseRule {
  int right_to_go_down{2};        ///< n, 2 or 3
  double start{0.6};              ///< [-], level
  double step_first{0.35};        ///< [-], of ln level, up
  double step{0.18};              ///< [-], from the third reversal on
  double down_over_up{0.5488};    ///< [-]; n = 3: 0.7393
  std::size_t reversals{12};      ///< of which the last `reversals_used` count; it ends after them
  std::size_t reversals_used{8};  ///< even
};

/// When enough was asked. Staircases end after their reversals, at `trials_max` at the latest.
struct StopRule {
  std::size_t trials_min{60};
  std::size_t trials_max{60};
  double ln_jnd_sd{};  ///< [-], ends between the two once the posterior is this narrow; 0: never
};

struct Method {
  MethodKind kind{MethodKind::QuestPlus};
  StaircaseRule staircase{};
  std::size_t constant_from{0};  ///< MethodKind::Constant: index of the first level it asks
  double quest_jnds{1.8};        ///< [-], MethodKind::Quest: level over JND
  StopRule stop{};
};

/// One run of a method. A value: the same answers lead to the same levels, so that a track is
/// rebuilt from the answers that were written down. The table outlives it.
class Track {
 public:
  /// `seed` and `stream` draw the order of constant stimuli.
  Track(const AnswerTable& table, const Method& method, std::uint64_t seed, std::uint64_t stream);

  /// Index of the next level; !done().
  [[nodiscard]] std::size_t next() const;
  /// The answer to a trial at that level.
  void told(std::size_t level, bool yes);
  /// An answer at a level that the track did not ask: it is believed, and changes no turn.
  void heard(std::size_t level, bool yes) { posterior_.told(level, yes); }
  [[nodiscard]] bool done() const;

  [[nodiscard]] std::size_t trials() const noexcept { return trials_; }
  [[nodiscard]] const AnswerPosterior& posterior() const noexcept { return posterior_; }
  /// Mean of the last reversals' levels; staircases that had that many.
  [[nodiscard]] std::optional<double> reversal_level() const;

 private:
  void move_staircase(bool yes);

  Method method_;
  AnswerPosterior posterior_;
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::size_t trials_{};
  // Staircases.
  double ln_level_{};  ///< [-]
  int right_in_a_row_{};
  int direction_{};                ///< -1 down, +1 up, 0 not yet
  std::vector<double> reversals_;  ///< [-], ln level
};

/// Share of right answers at which a staircase of that rule with its own ratio settles.
[[nodiscard]] double staircase_share(const StaircaseRule& rule);

}  // namespace palp::study
