#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/core/lapse.h"
#include "common/core/time.h"
#include "patient_site/servo_watch.h"

namespace palp::patient {

struct DeviceWatchConfig {
  double sensor_travel{3e-3};        ///< [m], of the tip: in contact every reading changes by then
  double sensor_band{10e-3};         ///< [N]: that is no change, but noise
  double contact_force{0.1};         ///< [N], no reading of the air
  std::uint32_t sensor_readings{5};  ///< so many more are the same as well: it may be slow
  double force_limit{3};             ///< [N], above it the gate retreats, whatever is stuck
  double pressed{0.5};               ///< [N], a contact that no reading ends while the tip stays
  double stays{0.3e-3};              ///< [m], out of the tissue: the tip stays
  Duration fall_time{std::chrono::milliseconds{25}};   ///< no tissue draws back so fast
  Duration gone_time{std::chrono::milliseconds{100}};  ///< and for so long
  ServoWatchConfig stage;
};

/// Notices devices that answer without fault and do not do their work any more: a transducer whose
/// reading stays the same while the tip moves in contact, or falls to nothing while the tip stays
/// in the tissue; a stage that does not go where it is sent. Such a transducer blinds every limit
/// of force. A reading of zero from the beginning on is told from quiet air only where the tissue
/// is known. Thread: rt. A value.
class DeviceWatch {
 public:
  struct Look {
    double tip{};         ///< [m]
    double target{};      ///< [m], of the tick before
    double force{};       ///< [N], the newest reading
    TimePoint at{};       ///< of this tick
    TimePoint felt_at{};  ///< of that reading
    bool in_tissue{};     ///< clearly deeper than the surface of this place
    bool follows{};       ///< the site follows its law: else only the stage is judged
  };

  explicit DeviceWatch(const DeviceWatchConfig& config) noexcept
      : config_{config}, stage_{config.stage} {}

  struct Stuck {
    bool sensor{};
    bool stage{};
  };
  /// Once a tick.
  [[nodiscard]] Stuck judge(const Look& look, const Lapse& lapse) noexcept {
    Stuck stuck{.stage = stage_.judge(look.tip, look.target, lapse.period)};
    if (!look.follows || !followed_) {
      begin_sensor(look);
      pressed_ = Pressed{};
    }
    followed_ = look.follows;
    if (look.follows) stuck.sensor = sensor_stuck(look) || force_vanished(look);
    return stuck;
  }

 private:
  /// When the tip pressed last, and where it stood.
  struct Pressed {
    bool known{};
    TimePoint at{};
    double tip{};  ///< [m]
    bool fell{};   ///< the readings since then are of the air
  };

  void begin_sensor(const Look& look) noexcept {
    force_ = look.force;
    lowest_ = highest_ = look.tip;
    felt_at_ = look.felt_at;
    same_ = 0;
  }
  [[nodiscard]] bool sensor_stuck(const Look& look) noexcept {
    const bool felt = std::abs(look.force) >= config_.contact_force;
    const bool contact = look.in_tissue || felt;
    // The tissue may have drawn back from the tip: then noise is no sign of a fault.
    const double band = felt ? config_.sensor_band : 0;
    if (std::abs(look.force - force_) > band || !contact || look.force > config_.force_limit) {
      begin_sensor(look);
    }
    if (std::exchange(felt_at_, look.felt_at) != look.felt_at) ++same_;
    lowest_ = std::min(lowest_, look.tip);
    highest_ = std::max(highest_, look.tip);
    return highest_ - lowest_ > config_.sensor_travel && same_ >= config_.sensor_readings;
  }
  /// A surface that breathes leaves the tip as well, but takes its time.
  [[nodiscard]] bool force_vanished(const Look& look) noexcept {
    const bool air = std::abs(look.force) < config_.contact_force;
    if (look.force >= config_.pressed) {
      pressed_ = {.known = true, .at = look.felt_at, .tip = look.tip};
    } else if (!look.in_tissue || look.tip < pressed_.tip - config_.stays ||
               (pressed_.fell && !air)) {
      pressed_ = Pressed{};
    } else if (pressed_.known && !pressed_.fell) {
      const bool too_late = look.felt_at - pressed_.at > config_.fall_time;
      if (air && !too_late) pressed_.fell = true;
      if (too_late) pressed_ = Pressed{};
    }
    return pressed_.fell && look.at - pressed_.at > config_.gone_time;
  }

  DeviceWatchConfig config_;
  ServoWatch stage_;
  bool followed_{};
  double force_{};    ///< [N], reading that stays
  double lowest_{};   ///< [m], tip, meanwhile
  double highest_{};  ///< [m]
  TimePoint felt_at_{};
  std::uint32_t same_{};  ///< readings after the first of them
  Pressed pressed_;
};

}  // namespace palp::patient
