#include "patient_site/force_check.h"

#include <cmath>
#include <utility>

#include "patient_site/sensor_check.h"

namespace palp::patient {
namespace {

template <class Reading>
SensorFeeling feeling_of(const Reading& reading, bool ready) {
  return {.ready = ready,
          .trouble = {},
          .number = reading.number,
          .force = reading.force,
          .zero = reading.zero,
          .saturated = reading.saturated};
}

}  // namespace

DeviceInstallation with_any_zero(DeviceInstallation built_in) noexcept {
  built_in.tare_within = built_in.force_range;
  return built_in;
}

Result<DevicePlan> check_cell(DevicePlan plan,
                              io::RegisterPort& port,
                              const Clock& clock,
                              const std::function<void(Duration)>& pass,
                              site_program::Dialogue& talk) {
  RegisterDevice device{plan.profile, with_any_zero(plan.installation), port};
  const auto step = [&] {
    pass(plan.profile.period);
    const DeviceReading reading = device.cycle(clock, {});
    SensorFeeling felt = feeling_of(reading, reading.state == DeviceState::Ready);
    if (reading.state == DeviceState::Fault) felt.trouble = describe_reason(reading, plan.profile);
    return felt;
  };
  const auto found = check_sensor(step, clock, talk);
  device.stop();
  port.close();
  if (!found) return tl::unexpected{found.error()};
  DeviceInstallation& built_in = plan.installation;
  const double unit = built_in.force_unit > 0 ? built_in.force_unit : plan.profile.force->unit;
  if (found->scale != 1) built_in.force_unit = unit * std::abs(found->scale);
  if (found->scale < 0) built_in.force_reversed = !built_in.force_reversed;
  built_in.force_zero = found->zero * found->scale;
  plan.noise = found->noise * std::abs(found->scale);
  return plan;
}

Result<CardPlan> check_card(CardPlan plan,
                            const ScanCard::Ports& ports,
                            const Clock& clock,
                            const std::function<void(Duration)>& pass,
                            site_program::Dialogue& talk) {
  CardInstallation built_in = plan.installation;
  built_in.load = with_any_zero(built_in.load);
  ScanCard card{built_in, ports};
  const auto step = [&] {
    pass(std::chrono::milliseconds{1});
    const CardReading reading = card.cycle(clock, {});
    SensorFeeling felt = feeling_of(reading, reading.state == CardState::Ready);
    if (reading.state == CardState::Fault) felt.trouble = reading.why;
    return felt;
  };
  const auto found = check_sensor(step, clock, talk);
  card.stop();
  if (!found) return tl::unexpected{found.error()};
  plan.installation.newtons_per_volt *= found->scale;
  plan.installation.load.force_zero = found->zero * found->scale;
  plan.noise = found->noise * std::abs(found->scale);
  return plan;
}

}  // namespace palp::patient
