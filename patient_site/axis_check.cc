#include "patient_site/axis_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "patient_site/force_check.h"

namespace palp::patient {
namespace {

using site_program::words;

constexpr Duration kReadyPatience = std::chrono::seconds{90};  // a drive may home
constexpr double kSpeed = 10e-3;                               // [m/s]
constexpr double kWay = 2e-3;                                  // [m]
constexpr double kThere = 0.1e-3;                              // [m], near enough
constexpr double kMargin = 1e-3;                               // [m], before a stop
constexpr double kSameScale = 0.05;                          // [-], of 2 mm; a ruler tells no more
constexpr double kStopWay = 1.5e-3;                          // [m], at that speed
constexpr double kStill = 1e-6;                              // [m], of a position without noise
constexpr Duration kMovePatience = std::chrono::seconds{3};  // until a motion begins or ends

}  // namespace

AxisCheck::AxisCheck(DevicePlan plan,
                     io::RegisterPort& port,
                     const Clock& clock,
                     std::function<void(Duration)> pass,
                     site_program::Dialogue& talk)
    : plan_{std::move(plan)}, port_{port}, clock_{clock}, pass_{std::move(pass)}, talk_{talk} {}

Result<DevicePlan> AxisCheck::run() {
  talk_.say(plan_.profile.name +
            ": keep a hand on the emergency stop. Nothing moves before you say yes.");
  Flaw flaw;
  for (const auto next : {&AxisCheck::look_at_rest,
                          &AxisCheck::move_by_a_ruler,
                          &AxisCheck::leave_it_alone,
                          &AxisCheck::find_limits}) {
    if (!flaw) flaw = (this->*next)();
  }
  if (device_) device_->stop();
  port_.close();
  if (flaw) return fail(*flaw);
  return plan_;
}

AxisCheck::Flaw AxisCheck::not_ready() const {
  if (now_.state == DeviceState::Ready) return std::nullopt;
  return "it is " + std::string{to_string(now_.state)} + ": " +
         describe_reason(now_, plan_.profile);
}

AxisCheck::Flaw AxisCheck::begin() {
  if (device_) device_->stop();
  port_.close();
  DeviceInstallation slow = with_any_zero(plan_.installation);
  slow.speed_max = std::min(slow.speed_max, kSpeed);
  slow.servo.time = Duration::max();  // it looks for stops, and stands at them
  device_ = std::make_unique<RegisterDevice>(plan_.profile, slow, port_);
  now_ = {};
  const TimePoint end = clock_.now() + kReadyPatience;
  while (now_.state != DeviceState::Ready && now_.state != DeviceState::Fault &&
         clock_.now() < end) {
    step(false, 0);
  }
  return not_ready();
}

const DeviceReading& AxisCheck::step(bool commanded, double target) {
  pass_(plan_.profile.period);
  DeviceCommand command;
  command.move = commanded;
  command.target = target;
  command.valid_until = clock_.now() + std::chrono::milliseconds{50};
  return now_ = device_->cycle(clock_, command);
}

/// Until it is there, or has come no nearer for a second: it stands, or it swings about.
AxisCheck::Flaw AxisCheck::go(double target) {
  double nearest = std::abs(now_.position - target);
  TimePoint nearer_at = clock_.now();
  while (std::abs(now_.position - target) > kThere) {
    step(true, target);
    if (auto flaw = not_ready()) return flaw;
    const double left = std::abs(now_.position - target);
    if (left < nearest - kThere) {
      nearest = left;
      nearer_at = clock_.now();
    } else if (clock_.now() - nearer_at > std::chrono::seconds{1}) {
      return words("it stands at %.2f mm, and was sent to %.2f", now_.position * 1e3, target * 1e3);
    }
  }
  return std::nullopt;
}

AxisCheck::Flaw AxisCheck::look_at_rest() {
  if (auto flaw = begin()) return flaw;
  constexpr int kCount = 50;
  Duration longest{};
  double least = now_.position;
  double most = now_.position;
  const std::uint64_t failures = now_.failures;
  for (int i = 0; i < kCount; ++i) {
    pass_(plan_.profile.period);
    const TimePoint began = clock_.now();
    now_ = device_->cycle(clock_, {});
    longest = std::max(longest, clock_.now() - began);
    least = std::min(least, now_.position);
    most = std::max(most, now_.position);
    if (auto flaw = not_ready()) return flaw;
  }
  noise_ = most - least;
  talk_.say(
      words("  stands at %.3f mm, quiet within %.3f mm; an answer takes %.1f ms at most, %llu "
            "of %d failed",
            now_.position * 1e3,
            noise_ * 1e3,
            seconds(longest) * 1e3,
            static_cast<unsigned long long>(now_.failures - failures),
            kCount));
  if (longest > plan_.profile.period) talk_.say("  That is longer than its period.");
  return std::nullopt;
}

AxisCheck::Flaw AxisCheck::move_by_a_ruler() {
  if (!talk_.confirm("Motion. It will go 2 mm away from the tissue, as its file has it. Is its way "
                     "free both ways?")) {
    return "it was not moved: without that it is not calibrated";
  }
  if (auto flaw = begin()) return flaw;
  const double from = now_.position;
  const TimePoint began = clock_.now();
  std::optional<Duration> begun;
  std::optional<Duration> half;
  while (!half) {
    step(true, from - kWay);
    if (auto flaw = not_ready()) return flaw;
    const double way = from - now_.position;
    if (!begun && way > kThere) begun = clock_.now() - began;
    if (way > kWay / 2) half = clock_.now() - began;
    if (clock_.now() - began > kMovePatience) return "it does not move";
  }
  if (auto flaw = go(from - kWay)) return flaw;
  const DeviceInstallation& built_in = plan_.installation;
  const double speed = std::min(built_in.speed_max, kSpeed);
  const double even = kWay / 2 / speed + speed / (2 * built_in.acceleration_max);
  plan_.lag = std::max(0.0, seconds(*half) - even);
  talk_.say(words("  it moved after %.0f ms, and lags %.0f ms behind an even motion",
                  seconds(*begun) * 1e3,
                  plan_.lag * 1e3));
  const auto side = talk_.one_of("Which way did it go: out of the tissue or in?", {"out", "in"});
  if (!side) return site_program::kNobodyAnswered;
  const auto way = talk_.number("By how many mm, by the ruler?", 0.05, 100);
  if (!way) return site_program::kNobodyAnswered;
  if (auto flaw = begin()) return flaw;
  if (auto flaw = go(from)) return flaw;
  DeviceInstallation& found = plan_.installation;
  const double factor = *way * 1e-3 / kWay;
  const double unit = found.position_unit > 0 ? found.position_unit : plan_.profile.position->unit;
  const double raw = found.zero + (found.reversed ? -from : from);
  if (*side == "in") found.reversed = !found.reversed;
  if (std::abs(factor - 1) > kSameScale) found.position_unit = unit * factor;
  // Where it stands keeps its name, whatever its counts are worth.
  found.zero = raw * (found.position_unit > 0 ? found.position_unit / unit : 1) -
               (found.reversed ? -from : from);
  talk_.say(words("  %.6g um per count%s",
                  (found.position_unit > 0 ? found.position_unit : unit) * 1e6,
                  *side == "in" ? ", and the other way round" : ""));
  return std::nullopt;
}

AxisCheck::Flaw AxisCheck::leave_it_alone() {
  if (auto flaw = begin()) return flaw;
  const double from = now_.position;
  TimePoint end = clock_.now() + kMovePatience;
  while (from - now_.position < kWay / 4) {
    if (clock_.now() > end) return "it does not move";
    step(true, from - 2 * kWay);
    if (auto flaw = not_ready()) return flaw;
  }
  const double left = now_.position;
  double before = left + 1;
  end = clock_.now() + kMovePatience;
  while (std::abs(before - now_.position) > std::max(kStill, noise_)) {
    if (clock_.now() > end) return "it does not come to rest although nobody commands it";
    before = now_.position;
    for (int i = 0; i < 10; ++i) step(false, 0);
    if (auto flaw = not_ready()) return flaw;
    if (left - now_.position > kStopWay) return "it goes on although nobody commands it";
  }
  talk_.say(words("  left alone it stopped after %.2f mm", (left - now_.position) * 1e3));
  return go(from);
}

AxisCheck::Flaw AxisCheck::find_limits() {
  const DeviceInstallation& built_in = plan_.installation;
  if (!talk_.confirm(
          words("Limits. It will go to both ends of its travel, %.1f and %.1f mm. Is all of "
                "that free, the tissue taken away?",
                built_in.travel_min * 1e3,
                built_in.travel_max * 1e3))) {
    talk_.say("  its limits were not tried: those of the file stay");
    return std::nullopt;
  }
  const double from = now_.position;
  if (auto flaw = find_limit(plan_.installation.travel_min, 1)) return flaw;
  if (auto flaw = find_limit(plan_.installation.travel_max, -1)) return flaw;
  if (auto flaw = begin()) return flaw;
  return go(from);
}

AxisCheck::Flaw AxisCheck::find_limit(double& limit, double inwards) {
  const double asked = limit;
  if (auto flaw = begin()) return flaw;  // from where it stands, wherever it was sent
  const Flaw stopped = go(asked);
  if (auto flaw = not_ready()) return flaw;
  if (stopped) limit = now_.position + inwards * kMargin;
  talk_.say(words("  %s %.1f mm: %.2f mm",
                  stopped ? "stopped short of" : "reached",
                  asked * 1e3,
                  now_.position * 1e3));
  return std::nullopt;
}

}  // namespace palp::patient
