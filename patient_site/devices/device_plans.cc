#include "patient_site/devices/device_plans.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palp::patient {

namespace {

// Bytes of request and reply together, beside their words: functions 3, 16 and 23.
constexpr std::size_t kReadFrame = 13;
constexpr std::size_t kWriteFrame = 17;
constexpr std::size_t kExchangeFrame = 18;

std::size_t words_of(const RegisterWrite& write) noexcept {
  std::size_t words = 0;
  for (const WriteValue& one : write.values) words += words_in(one.kind);
  return words;
}

/// What one period has on the line, the device's own delays included.
Duration time_of_period(const DeviceProfile& profile, const io::ModbusAddress& address) noexcept {
  std::size_t bytes = (profile.exchange ? kExchangeFrame : kReadFrame) + 2 * profile.read_count;
  const std::size_t frame = profile.exchange ? 0 : kWriteFrame;
  for (const RegisterWrite& one : profile.move) bytes += frame + 2 * words_of(one);
  const double bits = address.parity == 'N' ? 10 : 11;
  const std::size_t requests = 1 + (profile.exchange ? 0 : profile.move.size());
  return from_seconds(bits * static_cast<double>(bytes) / address.baud) +
         static_cast<std::int64_t>(requests) * profile.reply_delay;
}

}  // namespace

void fit_to_line(DeviceProfile& profile, const io::ModbusAddress& address) noexcept {
  if (address.line.empty()) return;
  const Duration needed = time_of_period(profile, address);
  if (needed <= profile.period) return;
  const double slower = seconds(needed) / seconds(profile.period);
  profile.period = needed;
  profile.silence = from_seconds(seconds(profile.silence) * slower);
}

StageFacts stage_facts_of(const DevicePlans& plans) noexcept {
  StageFacts facts;
  const DeviceInstallation& normal = plans.normal->installation;
  facts.axes = plans.x ? 3 : 1;
  facts.travel_min = normal.travel_min;
  facts.travel_max = normal.travel_max;
  facts.speed = normal.speed_max;
  facts.acceleration = normal.acceleration_max;
  facts.rate = 1 / seconds(plans.normal->profile.period);
  facts.lag = plans.normal->lag;
  facts.travel_side = 0;
  facts.drags = plans.x.has_value();
  if (!plans.x) return facts;
  facts.travel_side = 10;
  for (const auto* axis : {&plans.x, &plans.y}) {
    const DeviceInstallation& side = (*axis)->installation;
    facts.travel_side =
        std::min({facts.travel_side, std::abs(side.travel_min), std::abs(side.travel_max)});
    facts.speed = std::min(facts.speed, side.speed_max);
    facts.acceleration = std::min(facts.acceleration, side.acceleration_max);
  }
  return facts;
}

ForceSensorFacts sensor_facts_of(const DevicePlan& plan) noexcept {
  ForceSensorFacts facts;
  facts.pole = plan.pole;
  facts.step = plan.installation.force_unit > 0 ? plan.installation.force_unit
               : plan.profile.force             ? plan.profile.force->unit
                                                : 0;
  if (plan.profile.force && plan.profile.force->kind == WordKind::F32) facts.step = 0;
  facts.range = plan.installation.force_range;
  facts.noise = plan.noise;
  facts.yield = plan.yield;
  facts.rate = 1 / seconds(plan.profile.period);
  facts.lag = plan.lag;
  return facts;
}

ForceSensorFacts sensor_facts_of(const CardPlan& plan) noexcept {
  constexpr double kRate = 1000;         // [Hz], of packets
  constexpr double kCardDelay = 1.5e-3;  // [s], half a packet, and until its turn
  ForceSensorFacts facts;
  const CardInstallation& built_in = plan.installation;
  facts.pole = plan.pole;
  const CardModel& model = card_model(built_in.kind);
  facts.step =
      std::abs(built_in.newtons_per_volt) * 2 * model.full_scales.at(built_in.range) / model.steps;
  facts.range = built_in.load.force_range;
  facts.noise = plan.noise;
  facts.yield = plan.yield;
  facts.rate = kRate;
  facts.lag = kCardDelay + 1 / (2 * std::numbers::pi * plan.pole);
  return facts;
}

PatientDevices facts_of(const DevicePlans& plans) noexcept {
  return {stage_facts_of(plans),
          plans.card   ? sensor_facts_of(*plans.card)
          : plans.cell ? sensor_facts_of(*plans.cell)
                       : sensor_facts_of(*plans.normal)};
}

Duration sensor_silence_of(const DevicePlans& plans) noexcept {
  if (plans.card) return plans.card->installation.silence;
  return (plans.cell ? *plans.cell : *plans.normal).profile.silence;
}

}  // namespace palp::patient
