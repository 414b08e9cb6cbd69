#include "common/core/device_facts.h"

#include <array>
#include <charconv>
#include <initializer_list>

namespace palp {
namespace {

constexpr std::uint32_t kAxesMax = 6;
constexpr double kRateMax = 100'000;  // [Hz]

/// The shortest digits that say exactly this number.
std::string digits(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

struct Number {
  const char* name{};
  double value{};  ///< [unit]
  const char* unit{};
  double least{};  ///< [unit]
  double most{};   ///< [unit]
  bool above{};    ///< `least` itself is outside
};

std::optional<std::string> flaw_in(const char* device, std::initializer_list<Number> numbers) {
  for (const Number& number : numbers) {
    const bool high_enough =
        number.above ? number.value > number.least : number.value >= number.least;
    if (high_enough && number.value <= number.most) continue;  // NaN is neither
    return std::string{device} + "'s " + number.name + " of " + digits(number.value) + number.unit +
           (number.above ? " is not above " : " is not ") + digits(number.least) +
           (number.above ? " and at most " : " to ") + digits(number.most) + number.unit;
  }
  return std::nullopt;
}

std::optional<std::string> flaw_in(const HandFacts& hand) {
  return flaw_in("the hand",
                 {{"axes", static_cast<double>(hand.axes), "", 1, kAxesMax},
                  {"peak force", hand.force_peak, " N", 0.01, 1000},
                  {"continuous force", hand.force_continuous, " N", 0.01, hand.force_peak},
                  {"rate", hand.rate, " Hz", 1, kRateMax},
                  {"lag", hand.lag, " s", 0, 10}});
}

std::optional<std::string> flaw_in(const StageFacts& stage) {
  return flaw_in("the stage",
                 {{"axes", static_cast<double>(stage.axes), "", 1, kAxesMax},
                  {"travel outwards", stage.travel_min, " m", -10, 10},
                  {"travel inwards", stage.travel_max, " m", stage.travel_min, 10},
                  {"travel to the side", stage.travel_side, " m", 0, 10},
                  {"speed", stage.speed, " m/s", 0, 100, true},
                  {"acceleration", stage.acceleration, " m/s^2", 0, 10'000, true},
                  {"rate", stage.rate, " Hz", 1, kRateMax},
                  {"lag", stage.lag, " s", 0, 10}});
}

std::optional<std::string> flaw_in(const ForceSensorFacts& sensor) {
  return flaw_in("the force sensor",
                 {{"pole", sensor.pole, " Hz", 0.1, 100'000},
                  {"step", sensor.step, " N", 0, 1000},
                  {"range", sensor.range, " N", 0.01, 100'000},
                  {"noise", sensor.noise, " N", 0, 1000},
                  {"rate", sensor.rate, " Hz", 1, kRateMax},
                  {"lag", sensor.lag, " s", 0, 10},
                  {"yield", sensor.yield, " m/N", 0, 0.01}});
}

}  // namespace

std::optional<std::string> flaw_of(const DeviceFacts& facts) {
  std::optional<std::string> flaw;
  if (facts.hand) flaw = flaw_in(*facts.hand);
  if (!flaw && facts.stage) flaw = flaw_in(*facts.stage);
  if (!flaw && facts.sensor) flaw = flaw_in(*facts.sensor);
  return flaw;
}

std::string describe(const HandFacts& hand) {
  return std::to_string(hand.axes) + " axes, " + digits(hand.force_peak) + " N, " +
         digits(hand.force_continuous) + " N for ever, " + digits(hand.rate) + " Hz, lag " +
         digits(hand.lag) + " s";
}

std::string describe(const StageFacts& stage) {
  return std::to_string(stage.axes) + " axes, " + digits(stage.travel_min) + " to " +
         digits(stage.travel_max) + " m, +-" + digits(stage.travel_side) + " m, " +
         digits(stage.speed) + " m/s, " + digits(stage.acceleration) + " m/s^2, " +
         digits(stage.rate) + " Hz, lag " + digits(stage.lag) + " s, " +
         (stage.drags ? "drags" : "does not drag");
}

std::string describe(const ForceSensorFacts& sensor) {
  return "pole " + digits(sensor.pole) + " Hz, steps of " + digits(sensor.step) + " N, range " +
         digits(sensor.range) + " N, noise " + digits(sensor.noise) + " N rms, " +
         digits(sensor.rate) + " Hz, lag " + digits(sensor.lag) + " s, yield " +
         digits(sensor.yield) + " m/N";
}

}  // namespace palp
