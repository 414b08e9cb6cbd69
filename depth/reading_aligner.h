#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>

#include "common/message/depth.h"

namespace palp::depth {

struct ReadingAlignerConfig {
  double period{1e-3};         ///< [s], of what comes out
  double stage_rate{1000};     ///< [Hz], of the tip's readings
  double sensor_rate{1000};    ///< [Hz], of the force's
  double gap_max{20e-3};       ///< [s], between two readings, or ...
  double readings_missing{3};  ///< [-], ... so many of their periods: in between nothing is known
};

/// A sample whose tip and force are of one instant.
struct AlignedSample {
  ContactSample sample;  ///< without ages
  bool read{true};       ///< the force is a reading; else it lies between two of them
};

/// Samples that come at the rate of the site, with the newest readings of a stage and a sensor that
/// have rates and ages of their own, become samples whose tip and force are of one instant: those
/// at which the force was read and, in between, at even steps of about a period. A slow device's
/// reading is so counted once, where it was taken, not again and again while it stands. Devices
/// that read at every tick pass unchanged.
/// What comes out is later than what goes in by up to two readings. Thread: one; allocates.
class ReadingAligner {
 public:
  explicit ReadingAligner(const ReadingAlignerConfig& config) noexcept : config_{config} {}

  void add(const ContactSample& sample);
  /// The next that is known now; nullopt: none yet. Over a gap of readings their time jumps.
  [[nodiscard]] std::optional<AlignedSample> take();
  void reset() noexcept { *this = ReadingAligner{config_}; }

 private:
  struct Reading {
    TimePoint at{};
    double value{};  ///< [m] or [N]
    Place place;
  };

  /// Of the tip at an instant.
  struct Seen {
    std::optional<double> tip;  ///< [m]
    bool ever{true};            ///< false: no reading that comes later will tell
  };

  [[nodiscard]] double gap_of(double rate) const noexcept;
  [[nodiscard]] Seen tip_at(TimePoint at);
  /// What comes after forces_[0], which came out, on the way to forces_[1].
  [[nodiscard]] std::optional<AlignedSample> next_step();
  void give_up() noexcept;

  ReadingAlignerConfig config_;
  std::deque<Reading> tips_;    ///< from the last two before what comes next
  std::deque<Reading> forces_;  ///< the first came out, once begun; the others shall
  bool begun_{};
  std::size_t steps_done_{};  ///< of those between the first two forces
};

}  // namespace palp::depth
