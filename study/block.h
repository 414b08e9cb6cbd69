#pragma once

#include <cstddef>
#include <vector>

#include "study/schedule.h"
#include "study/track.h"

namespace palp::study {

/// One trial as it is to be given.
struct TrialAsk {
  TrialKind kind{};
  std::size_t number{};  ///< in its block, practice included, from 0
  std::size_t track{};
  double level{};  ///< [as the study's]
  /// The interval that holds the stronger stimulus, from 0; yes or no: 1, there is something; a
  /// ranking: the order, of kOrders.
  std::size_t stronger{};
  std::size_t decoy{};   ///< place by way of which the stage travels
  Place hidden{};        ///< a search: the ball's axis, from the middle of the area
  std::size_t before{};  ///< trials before it, without practice
  std::size_t count{};   ///< of all of the block, likewise
};

/// Where a participant stands under one condition: a value that the schedule and the answers so far
/// make, so that it is made again from the answers that were written down. Owns no clock. `study`,
/// `table` and `plan` outlive it.
class Block {
 public:
  Block(const Study& study, const AnswerTable& table, const BlockPlan& plan);

  /// Every trial was answered, or too much practice was needed.
  [[nodiscard]] bool done() const noexcept;
  /// Practice did not help: the participant is excluded by the rule of the study.
  [[nodiscard]] bool excluded() const noexcept;
  /// !done().
  [[nodiscard]] TrialAsk next() const;
  /// The answer to next(): right; at a two-sided task "the second is stiffer".
  void told(bool yes);

  [[nodiscard]] std::size_t answered() const noexcept { return practice_.size() + trials_; }
  /// Of all tracks together: ln JND as believed now. One track's alone is less certain.
  [[nodiscard]] Marginal believed(std::size_t track) const;

 private:
  [[nodiscard]] bool practised() const noexcept;

  const Study* study_;
  const BlockPlan* plan_;
  std::vector<Track> tracks_;
  std::vector<bool> practice_;  ///< right
  std::size_t trials_{};        ///< answered, catch trials included
};

}  // namespace palp::study
