#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/time.h"
#include "netem/model/path_plan.h"
#include "netem/model/prepared_law.h"

namespace palp::netem {

/// A change that is ready to be applied at any moment.
struct PreparedChange {
  Duration at{};
  Change::Kind kind{};
  Duration span{};
  std::size_t copies{};
  std::unique_ptr<PreparedLaw> law;  ///< Set and Ramp
  std::uint64_t law_number{};        ///< its name, see ImpairedPath::law_number()
};
[[nodiscard]] PreparedChange prepare(const Change& change);

/// Goes through the changes of a plan, round after round if it loops. Its laws stay whole: a round
/// goes on where the last one ended. Thread: its owner's, fit for rt once constructed.
class PlanCursor {
 public:
  PlanCursor(const PathPlan& plan, TimePoint start);

  /// Calls `act` with each change that is due at `at` and the time at which it was.
  template <class Act>
  void pass(TimePoint at, Act&& act) noexcept {
    while (next_ < changes_.size() && start_ + shift_ + changes_[next_].at <= at) {
      skip_rounds(at);
      const PreparedChange& change = changes_[next_];
      act(change, start_ + shift_ + change.at);
      if (++next_ == changes_.size() && loop_ > Duration{}) {
        next_ = 0;
        shift_ += loop_;
      }
    }
  }
  /// Changes of rounds that began and ended unseen: pass() left them out.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }
  /// The number of the law that holds at `at`, if that of number `held` holds now.
  [[nodiscard]] std::uint64_t law_number(TimePoint at, std::uint64_t held) const noexcept;

 private:
  void skip_rounds(TimePoint at) noexcept;

  std::vector<PreparedChange> changes_;
  TimePoint start_;
  Duration loop_;
  std::size_t next_{};
  Duration shift_{};  ///< where the present round begins, since the start
  std::uint64_t skipped_{};
};

}  // namespace palp::netem
