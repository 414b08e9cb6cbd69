#include "patient_site/sensor_check.h"

#include <cmath>

namespace palp::patient {
namespace {

using site_program::words;

constexpr Duration kTarePatience = std::chrono::seconds{10};
constexpr Duration kSettle = std::chrono::seconds{1};
constexpr Duration kLook = std::chrono::seconds{2};
constexpr double kForceMin = 0.2;      // [N], less is no calibration
constexpr double kRest = 0.05;         // [-], of the weight, that may stay
constexpr double kSameWeight = 0.005;  // [-]

struct Mean {
  double force{};
  double rms{};
  double rate{};
};

std::optional<std::string> mean_over(const std::function<SensorFeeling()>& step,
                                     const Clock& clock,
                                     Mean& mean) {
  const auto pass = [&](Duration span, auto each) -> std::optional<std::string> {
    for (const TimePoint began = clock.now(); clock.now() - began < span;) {
      const SensorFeeling one = step();
      if (!one.ready) return one.trouble.empty() ? "it is not ready" : one.trouble;
      if (one.saturated) return "it is saturated";
      each(one);
    }
    return std::nullopt;
  };
  if (auto flaw = pass(kSettle, [](const SensorFeeling&) {})) return flaw;
  double sum = 0;
  double square = 0;
  double count = 0;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  const TimePoint began = clock.now();
  auto flaw = pass(kLook, [&](const SensorFeeling& one) {
    if (first == 0) first = one.number;
    if (one.number == last) return;
    last = one.number;
    sum += one.force;
    square += one.force * one.force;
    ++count;
  });
  if (flaw) return flaw;
  mean.force = sum / count;
  mean.rms = std::sqrt(std::fmax(0, square / count - mean.force * mean.force));
  mean.rate = static_cast<double>(last - first) / seconds(clock.now() - began);
  return std::nullopt;
}

}  // namespace

Result<SensorFound> check_sensor(const std::function<SensorFeeling()>& step,
                                 const Clock& clock,
                                 site_program::Dialogue& talk) {
  if (!talk.wait_for_enter("Zero. Let nothing touch the sensor."))
    return fail(site_program::kNobodyAnswered);
  SensorFeeling one;
  for (const TimePoint began = clock.now(); !one.ready && clock.now() - began < kTarePatience;) {
    one = step();
    if (!one.trouble.empty()) return fail(one.trouble);
  }
  if (!one.ready) return fail("it is not ready after 10 s");
  Mean quiet;
  if (auto flaw = mean_over(step, clock, quiet)) return fail(*flaw);
  SensorFound found{.scale = 1, .noise = quiet.rms, .zero = one.zero, .rate = quiet.rate};
  talk.say(words("  %.0f readings/s; unloaded %.3f N, noise %.1f mN",
                 found.rate,
                 found.zero,
                 found.noise * 1e3));
  const auto weight = talk.number(
      "Scale. Load it with a known weight, as the tissue would press it, and leave it there. How "
      "many newtons (100 g are 0.981 N)?",
      kForceMin,
      1000);
  if (!weight) return fail(site_program::kNobodyAnswered);
  Mean loaded;
  if (auto flaw = mean_over(step, clock, loaded)) return fail(*flaw);
  const double felt = loaded.force - quiet.force;
  if (std::abs(felt) < 10 * found.noise) return fail("it did not feel the weight");
  found.scale = *weight / felt;
  if (std::abs(found.scale - 1) < kSameWeight) found.scale = 1;
  talk.say(words("  it read %.3f N: %s, its unit times %.4f",
                 felt,
                 felt > 0 ? "compression is positive" : "the other way round",
                 std::abs(found.scale)));
  if (!talk.wait_for_enter("Take the weight away.")) return fail(site_program::kNobodyAnswered);
  Mean after;
  if (auto flaw = mean_over(step, clock, after)) return fail(*flaw);
  const double left = std::abs((after.force - quiet.force) * found.scale);
  talk.say(words("  it came back to within %.0f mN", left * 1e3));
  if (left > kRest * *weight) return fail("it does not come back to 0");
  return found;
}

}  // namespace palp::patient
