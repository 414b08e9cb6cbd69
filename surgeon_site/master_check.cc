#include "surgeon_site/master_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::surgeon {
namespace {

using site_program::words;
using std::chrono::milliseconds;

constexpr Duration kCheckStep = milliseconds{1};
constexpr Duration kReadyPatience = std::chrono::seconds{5};
constexpr Duration kShort = milliseconds{300};
constexpr Duration kPushTime = milliseconds{500};
constexpr Duration kWeighTime = std::chrono::seconds{3};
constexpr double kAnyTravel = 1;     // [m], while limits are not known
constexpr double kMargin = 1e-3;     // [m], between the stops and a fault
constexpr double kWayMin = 2;        // [-], times the noise: a motion
constexpr double kMovedMin = 50e-6;  // [m]
constexpr double kRateMin = 5;       // [1/s], of reports
constexpr double kPushShare = 0.1;   // [-], of the peak force
constexpr double kWeighShare = 0.3;  // [-]
constexpr double kSameScale = 0.01;  // [-], nearer no ruler tells

}  // namespace

MasterCheck::MasterCheck(MasterPlan plan,
                         io::ReportPort& port,
                         const Clock& clock,
                         std::function<void(Duration)> pass,
                         site_program::Dialogue& talk)
    : plan_{std::move(plan)}, port_{port}, clock_{clock}, pass_{std::move(pass)}, talk_{talk} {}

Result<MasterPlan> MasterCheck::run() {
  talk_.say(std::string{plan_.product->name} +
            ": keep a hand on the emergency stop. Nothing moves before you say yes.");
  Flaw flaw = look_at_rest();
  if (plan_.product->force) {
    for (const auto next : {&MasterCheck::measure_scale,
                            &MasterCheck::set_zero,
                            &MasterCheck::find_limits,
                            &MasterCheck::push,
                            &MasterCheck::weigh}) {
      if (!flaw) flaw = (this->*next)();
    }
  }
  if (device_) device_->stop();
  port_.close();
  if (flaw) return fail(*flaw);
  return plan_;
}

/// Anew, so that nothing of what it said while a person read counts. Limits that were found hold
/// from then on: a motor pushes nobody beyond them.
MasterCheck::Flaw MasterCheck::begin() {
  if (device_) device_->stop();
  port_.close();
  MasterInstallation wide = plan_.installation;
  if (!limits_found_) {
    wide.travel_min = -kAnyTravel;
    wide.travel_max = kAnyTravel;
  }
  device_ = std::make_unique<MasterDevice>(make_protocol(plan_), wide, port_);
  const TimePoint end = clock_.now() + kReadyPatience;
  MasterReading reading;
  while (reading.state != MasterState::Ready && clock_.now() < end) {
    reading = step(0);
    if (reading.state == MasterState::Fault) break;
  }
  if (reading.state == MasterState::Ready) return std::nullopt;
  return "it is not ready: " + std::string{reading.why.empty() ? "no report" : reading.why};
}

MasterReading MasterCheck::step(double force) {
  pass_(kCheckStep);
  return device_->cycle(clock_,
                        {.force = force,
                         .engaged = false,
                         .valid_until = clock_.now() + 20 * kCheckStep,
                         .restarts = 0});
}

MasterCheck::Flaw MasterCheck::watch(Duration span, Seen& seen) {
  if (auto flaw = begin()) return flaw;
  const TimePoint began = clock_.now();
  MasterReading reading = step(0);
  const std::uint64_t first = reading.number;
  double sum = 0;
  int count = 0;
  double least = reading.position;
  double most = reading.position;
  while (clock_.now() - began < span) {
    reading = step(0);
    if (reading.state != MasterState::Ready) return std::string{reading.why};
    sum += reading.position;
    least = std::min(least, reading.position);
    most = std::max(most, reading.position);
    ++count;
  }
  const double time = seconds(clock_.now() - began);
  seen = {.place = sum / std::max(1, count),
          .spread = most - least,
          .rate = static_cast<double>(reading.number - first) / time};
  return std::nullopt;
}

MasterCheck::Flaw MasterCheck::look_at_rest() {
  if (!talk_.wait_for_enter("Rest. Let go of it.")) return site_program::kNobodyAnswered;
  Seen seen;
  if (auto flaw = watch(std::chrono::seconds{1}, seen)) return flaw;
  noise_ = seen.spread;
  talk_.say(words("  %.0f reports/s, quiet within %.3f mm", seen.rate, noise_ * 1e3));
  if (plan_.product->force && seen.rate < kRateMin) return "it hardly reports";
  return std::nullopt;
}

MasterCheck::Flaw MasterCheck::measure_scale() {
  if (!talk_.wait_for_enter("Scale. Put it in the middle of its way, and a ruler beside it.")) {
    return site_program::kNobodyAnswered;
  }
  Seen before;
  if (auto flaw = watch(kShort, before)) return flaw;
  const auto way = talk_.number(
      "Move it as into the tissue, 10 mm or more, and hold it. By how many mm?", 1, 500);
  if (!way) return site_program::kNobodyAnswered;
  Seen after;
  if (auto flaw = watch(kShort, after)) return flaw;
  const double moved = after.place - before.place;
  if (std::abs(moved) <= kWayMin * noise_) return "it did not see the motion";
  MasterInstallation& built_in = plan_.installation;
  const double factor = *way * 1e-3 / std::abs(moved);
  if (std::abs(factor - 1) > kSameScale) {
    built_in.position_unit *= factor;
    built_in.zero *= factor;
  }
  if (moved < 0) built_in.reversed = !built_in.reversed;
  talk_.say(words("  it read %.2f mm: %.6g um per count%s",
                  moved * 1e3,
                  built_in.position_unit * 1e6,
                  moved < 0 ? ", and the other way round" : ""));
  return std::nullopt;
}

MasterCheck::Flaw MasterCheck::set_zero() {
  if (!talk_.wait_for_enter("Zero. Hold it where the tissue's surface shall be."))
    return site_program::kNobodyAnswered;
  Seen seen;
  if (auto flaw = watch(kShort, seen)) return flaw;
  MasterInstallation& built_in = plan_.installation;
  built_in.zero += seen.place * (built_in.reversed ? -1 : 1);
  talk_.say(words("  it reads %.2f mm there", built_in.zero * 1e3));
  return std::nullopt;
}

MasterCheck::Flaw MasterCheck::find_limits() {
  Seen out;
  Seen in;
  if (!talk_.wait_for_enter("Limits. Pull it out to its stop and hold it."))
    return site_program::kNobodyAnswered;
  if (auto flaw = watch(kShort, out)) return flaw;
  if (!talk_.wait_for_enter("Push it in to its stop and hold it."))
    return site_program::kNobodyAnswered;
  if (auto flaw = watch(kShort, in)) return flaw;
  if (in.place - out.place < 4 * kMargin) return "its way is no way: in is not beyond out";
  plan_.installation.travel_min = out.place - kMargin;
  plan_.installation.travel_max = in.place + kMargin;
  limits_found_ = true;
  talk_.say(words("  from %.1f to %.1f mm", out.place * 1e3, in.place * 1e3));
  return std::nullopt;
}

MasterCheck::Flaw MasterCheck::push() {
  const double force = kPushShare * plan_.installation.force_max;
  if (!talk_.confirm(
          words("Force. Put it in the middle and let go; it will push with %.2f N, half a "
                "second each way. Shall it?",
                force))) {
    return "the force was not tried: without that it is not calibrated";
  }
  double out = 0;
  double in = 0;
  Duration after{};
  Duration after_in{};
  if (auto flaw = push_once(force, out, after)) return flaw;
  if (auto flaw = push_once(-force, in, after_in)) return flaw;
  if ((out < 0) == (in < 0)) return "it moved the same way twice: not by its motor";
  const bool wrong = out > 0;
  if (wrong) plan_.installation.force_reversed = !plan_.installation.force_reversed;
  plan_.facts.lag = seconds(std::max(after, after_in));
  talk_.say(words("  it moved %.2f and %.2f mm, after %.0f ms%s",
                  out * 1e3,
                  in * 1e3,
                  plan_.facts.lag * 1e3,
                  wrong ? ": its force was the wrong way round" : ""));
  return std::nullopt;
}

MasterCheck::Flaw MasterCheck::push_once(double force, double& moved, Duration& after) {
  Seen before;
  if (auto flaw = watch(kShort, before)) return flaw;
  const TimePoint began = clock_.now();
  const double enough = kMovedMin + kWayMin * noise_;
  bool begun = false;
  while (clock_.now() - began < kPushTime) {
    const MasterReading reading = step(force);
    if (reading.state != MasterState::Ready) return std::string{reading.why};
    moved = reading.position - before.place;
    if (!begun && std::abs(moved) > enough) {
      begun = true;
      after = clock_.now() - began;
    }
  }
  device_->stop();
  if (!begun) return "it did not move: no power, too little force, or a false scale of it";
  return std::nullopt;
}

MasterCheck::Flaw MasterCheck::weigh() {
  const double force = kWeighShare * plan_.installation.force_max;
  if (!talk_.confirm(
          words("Weight. Hold a scale in the way it pushes out; it will push with %.2f N "
                "for 3 s. Shall it?",
                force))) {
    talk_.say("  its force was not weighed: the unit of the file stays");
    return std::nullopt;
  }
  if (auto flaw = begin()) return flaw;
  const TimePoint began = clock_.now();
  while (clock_.now() - began < kWeighTime) {
    const MasterReading reading = step(force);
    if (reading.state != MasterState::Ready) return std::string{reading.why};
  }
  device_->stop();
  const auto shown = talk_.number("How many newtons did it show (100 g are 0.981 N)?", 0.01, 50);
  if (!shown) return site_program::kNobodyAnswered;
  const double factor = *shown / force;
  if (std::abs(factor - 1) > kSameScale) plan_.installation.force_unit *= factor;
  talk_.say(words("  %.6g mN per count", plan_.installation.force_unit * 1e3));
  return std::nullopt;
}

}  // namespace palp::surgeon
