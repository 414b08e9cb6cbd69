#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/core/lapse.h"
#include "common/core/time.h"

namespace palp::patient {

struct DeviceWatchConfig {
  double sensor_travel{3e-3};        ///< [m], of the tip: in contact every reading changes by then
  double contact_force{0.1};         ///< [N], no reading of the air
  std::uint32_t sensor_readings{5};  ///< so many more are the same as well: it may be slow
  double force_limit{3};             ///< [N], above it the gate retreats, whatever is stuck
  double stage_error{1e-3};          ///< [m], from the tip to its target: a servo is on its way
  double stage_still{0.1e-3};        ///< [m]: that is no way
  Duration stage_time{std::chrono::milliseconds{300}};  ///< so long: it does not follow
};

/// Notices devices that answer without fault and do not do their work any more: a transducer whose
/// reading stays the same, to the last count, while the tip moves in contact; a stage that stays
/// where it is while its target is elsewhere. Such a transducer blinds every limit of force, and
/// such a stage jumps to its target when it comes free. A reading of zero that never changes is
/// told from quiet air only where the tissue is known. Thread: rt. A value.
class DeviceWatch {
 public:
  struct Look {
    double tip{};         ///< [m]
    double target{};      ///< [m], of the tick before
    double force{};       ///< [N], the newest reading
    TimePoint felt_at{};  ///< of that reading
    bool in_tissue{};     ///< clearly deeper than the surface of this place
  };

  explicit DeviceWatch(const DeviceWatchConfig& config) noexcept : config_{config} {}

  struct Stuck {
    bool sensor{};
    bool stage{};
  };
  void reset() noexcept { begun_ = false; }
  /// Once a tick while the site follows its law.
  [[nodiscard]] Stuck judge(const Look& look, const Lapse& lapse) noexcept {
    if (!begun_) begin(look);
    begun_ = true;
    return {.sensor = sensor_stuck(look), .stage = stage_stuck(look, lapse)};
  }

 private:
  void begin(const Look& look) noexcept {
    begin_sensor(look);
    still_at_ = look.tip;
    still_for_ = Duration{0};
  }
  void begin_sensor(const Look& look) noexcept {
    force_ = look.force;
    lowest_ = highest_ = look.tip;
    felt_at_ = look.felt_at;
    same_ = 0;
  }
  [[nodiscard]] bool sensor_stuck(const Look& look) noexcept {
    const bool contact = look.in_tissue || std::abs(look.force) >= config_.contact_force;
    if (look.force != force_ || !contact || look.force > config_.force_limit) begin_sensor(look);
    if (std::exchange(felt_at_, look.felt_at) != look.felt_at) ++same_;
    lowest_ = std::min(lowest_, look.tip);
    highest_ = std::max(highest_, look.tip);
    return highest_ - lowest_ > config_.sensor_travel && same_ >= config_.sensor_readings;
  }
  [[nodiscard]] bool stage_stuck(const Look& look, const Lapse& lapse) noexcept {
    const bool on_its_way = std::abs(look.tip - still_at_) > config_.stage_still;
    if (on_its_way || std::abs(look.target - look.tip) <= config_.stage_error) {
      still_at_ = look.tip;
      still_for_ = Duration{0};
    }
    // A late tick proves no more than a short one: nothing was looked at in between.
    still_for_ += lapse.period;
    return still_for_ > config_.stage_time;
  }

  DeviceWatchConfig config_;
  bool begun_{};
  double force_{};    ///< [N], reading that stays
  double lowest_{};   ///< [m], tip, meanwhile
  double highest_{};  ///< [m]
  TimePoint felt_at_{};
  std::uint32_t same_{};  ///< readings after the first of them
  double still_at_{};     ///< [m], tip
  Duration still_for_{};
};

}  // namespace palp::patient
