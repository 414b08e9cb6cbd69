#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/place.h"
#include "study/study_file.h"

/// Who does what in which order: all of it drawn from the study's seed before anybody is asked.
/// Pure.
namespace palp::study {

enum class TrialKind : std::uint8_t {
  Trial,
  Catch,     ///< at the easiest level: shows who does not attend
  Practice,  ///< easy, and told afterwards whether right
};

[[nodiscard]] constexpr std::string_view to_string(TrialKind kind) noexcept {
  switch (kind) {
    case TrialKind::Trial:
      return "trial";
    case TrialKind::Catch:
      return "catch";
    case TrialKind::Practice:
      return "practice";
  }
  return "?";
}

/// What is known of a trial before its level is.
struct Slot {
  TrialKind kind{};
  std::size_t track{};  ///< of TrialKind::Trial
  /// The interval that holds the stronger stimulus, from 0; two-sided tasks: of easy trials only;
  /// yes or no: 1, there is something; a ranking: the order, of kOrders.
  std::size_t stronger{};
  std::size_t decoy{};  ///< place by way of which the stage travels, 0 to 3
  Place hidden{};       ///< a search: the ball's axis, from the middle of the area
};

/// All of a participant under one condition.
struct BlockPlan {
  std::size_t condition{};
  std::uint64_t stream{};        ///< of random numbers, its own
  std::vector<Slot> practice{};  ///< as many as there may be
  std::vector<Slot> trials{};
};

/// Blocks in the order of a row of a Williams square. `participant` from 0.
[[nodiscard]] std::vector<BlockPlan> participant_plan(const Study& study, std::size_t participant);

/// The letter that stands for a condition on every screen and in every file. Conditions are in the
/// order of their letters but where a study is as its file has it (letters.h).
[[nodiscard]] std::string condition_code(std::size_t condition);

/// 0 to count-1 in an order drawn by seed.
[[nodiscard]] std::vector<std::size_t> drawn_order(std::size_t count,
                                                   std::uint64_t seed,
                                                   std::uint64_t stream);

/// `count` numbers below `kinds` >= 2, as even as can be and never more than 4 equal ones on end.
[[nodiscard]] std::vector<std::size_t> balanced_draw(std::size_t count,
                                                     std::size_t kinds,
                                                     std::uint64_t seed,
                                                     std::uint64_t stream);

/// The schedule of all participants as JSON, with codes in place of conditions: what is registered
/// and hashed. It does not depend on which condition has which code.
[[nodiscard]] std::string schedule_text(const Study& study);

}  // namespace palp::study
