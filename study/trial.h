#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/time.h"

namespace palp::study {

enum class TrialStage : std::uint8_t {
  Travel,   ///< to the place of the next interval, by way of the decoy; takes the same each time
  Explore,  ///< the hand taps
  Answer,   ///< which one? without a limit
  Told,     ///< practice: right or wrong is shown
  Done,
  Ended,  ///< the pedal came up in Travel or Explore: the trial is given again
};

struct TrialTimes {
  Duration travel{std::chrono::milliseconds{1500}};
  Duration explore_max{std::chrono::seconds{8}};
  Duration told{std::chrono::seconds{1}};
  /// The hand goes where it likes, however often it is let go of, and the answer comes while it
  /// explores; after `explore_max` it is asked for.
  bool searches{};
};

/// What happened since the last tick.
struct TrialInput {
  double force{};                       ///< [N], that the hand was given, any sign
  bool contact{};                       ///< the tip touches, whether the hand is told or not
  bool pedal{true};                     ///< held
  std::optional<std::size_t> answer{};  ///< the interval, or else what was chosen, from 0
};

/// One trial as a state machine: it moves only in tick(now), and knows neither
/// device nor screen. Counts taps by contacts that end. An answer counts in TrialStage::Answer
/// only, of a search in TrialStage::Explore too, and if there is such a choice. A value.
class Trial {
 public:
  /// `intervals` >= 1. `taps` >= 1 of an interval end it, once out of the tissue, or explore_max
  /// does. `choices`: answers there are; 0: an interval each.
  Trial(std::size_t intervals,
        int taps,
        bool practice,
        const TrialTimes& times,
        std::size_t choices = 0) noexcept;

  /// `now` does not go back. The first call begins the trial.
  void tick(TimePoint now, const TrialInput& in) noexcept;

  [[nodiscard]] TrialStage stage() const noexcept { return stage_; }
  /// From 0: the interval felt now, or travelled to.
  [[nodiscard]] std::size_t interval() const noexcept { return interval_; }
  /// First half of a travel: the stage makes for the decoy.
  [[nodiscard]] bool by_decoy(TimePoint now) const noexcept;
  [[nodiscard]] std::optional<std::size_t> answer() const noexcept { return answer_; }
  /// From the question on; of a search from its begin.
  [[nodiscard]] Duration response_time() const noexcept { return response_time_; }
  [[nodiscard]] int taps() const noexcept { return taps_; }
  [[nodiscard]] int taps_of_interval() const noexcept { return taps_now_; }  ///< of the one now
  [[nodiscard]] double force_max() const noexcept { return force_max_; }     ///< [N], magnitude
  [[nodiscard]] Duration contact() const noexcept { return contact_; }
  [[nodiscard]] Duration length(TimePoint now) const noexcept;  ///< since the trial began

 private:
  void enter(TrialStage stage, TimePoint now) noexcept;
  void explore(TimePoint now, const TrialInput& in) noexcept;
  void hear(TimePoint now, const TrialInput& in) noexcept;

  std::size_t intervals_;
  std::size_t choices_;
  int taps_wanted_;
  bool practice_;
  TrialTimes times_;
  TrialStage stage_{TrialStage::Travel};
  std::size_t interval_{};
  std::optional<TimePoint> began_at_;
  TimePoint entered_at_{};
  TimePoint asked_at_{};
  TimePoint last_{};
  bool touching_{};
  int taps_{};          ///< of all intervals
  int taps_now_{};      ///< of this one
  double force_max_{};  ///< [N]
  Duration contact_{};
  std::optional<std::size_t> answer_;
  Duration response_time_{};
};

}  // namespace palp::study
