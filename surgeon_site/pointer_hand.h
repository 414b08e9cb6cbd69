#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/pointer_report.h"
#include "common/core/time.h"
#include "surgeon_site/encoder.h"
#include "surgeon_site/hand_plant.h"
#include "surgeon_site/haptic_device.h"

namespace palp::surgeon {

struct PointerHandConfig {
  HandPlantConfig plant;
  double encoder_step{0.03e-3};   ///< [m] > 0
  double velocity_cut_off{60.0};  ///< [Hz], low pass on the encoder's rate
  double force_max{8.5};          ///< [N], what such a device could give at most
  double force_continuous{1.4};   ///< [N]
  /// A finger of which nothing was heard for longer is up.
  Duration silence_max{std::chrono::milliseconds{150}};
  /// Reports come every 16 ms, unevenly; they are followed so much later, evenly.
  Duration play_out{std::chrono::milliseconds{20}};
  double will_cut_off{10.0};   ///< [Hz], no hand moves faster than that
  double speed_max{60e-3};     ///< [m/s]
  double reach{20e-3};         ///< [m], that one press may go in or out
  double reach_aside{100e-3};  ///< [m], along the surface
};

/// A hand made of a pointer on a screen: the finger that is drawn is the will of a passive hand,
/// not its place, so that the law, the gate and the supervisor see a hand like any other; force
/// moves it away from the will. The pedal is down while the finger is, and is heard of in time:
/// a press that was once over never comes back. Thread: rt.
class PointerHand final : public HapticDevice {
 public:
  explicit PointerHand(const PointerHandConfig& config);

  /// Writer: the monitor's thread. Reader: rt.
  [[nodiscard]] Mailbox<PointerReport>& reports() noexcept { return reports_; }

  /// The first call only sets the time line; after more than 100 ms without one, 100 ms are lived.
  HandState read(TimePoint now) noexcept override;
  void apply(double force) noexcept override;
  void show(const OperatorView& /*view*/) noexcept override {}
  [[nodiscard]] HandFacts hand_facts() const noexcept override;

 private:
  /// Where the finger has been drawn to since it went down.
  struct Drawn {
    TimePoint at{};
    double into{};  ///< [m]
    double x{};     ///< [m]
    double y{};     ///< [m]
  };
  /// One of the three after the other filters, on its way to the hand.
  struct Will {
    double smooth{};  ///< [m]
    double now{};     ///< [m]
    void follow(double aim, double gain, double step_max) noexcept;
  };

  void hear(TimePoint now) noexcept;
  void press(const PointerReport& report) noexcept;
  void let_go() noexcept;
  void keep(const Drawn& drawn) noexcept;
  [[nodiscard]] Drawn drawn_at(TimePoint at) const noexcept;
  void live(Duration span) noexcept;

  static constexpr std::size_t kKept = 8;  ///< more than arrive within the play-out

  PointerHandConfig config_;
  HandPlant plant_;
  Encoder encoder_;
  Mailbox<PointerReport> reports_;
  std::array<Drawn, kKept> kept_{};  ///< a ring; the newest is at kept_[count_ - 1]
  std::size_t count_{};
  TimePoint heard_at_{};
  std::uint32_t press_{};  ///< in progress; 0: none
  std::uint32_t over_{};   ///< presses up to this number have ended
  double base_{};          ///< [m], where the hand was as the finger went down
  Place base_place_;
  Will into_, x_, y_;
  Pull pull_;
  HandState state_;
  double force_{};  ///< [N]
  bool started_{};
};

}  // namespace palp::surgeon
