#include "netem/impairment.h"

#include <array>
#include <charconv>

namespace palp::netem {
namespace {

/// Shortest decimal text that reads back as the same number.
std::string decimal(double value) {
  std::array<char, 400> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed);
  return {buffer.data(), end.ptr};
}

/// 0.0125 -> "1.25%": the decimal point is moved in the text, so that no rounding comes in.
std::string share_text(double share) {
  std::string digits = decimal(share);
  std::size_t point = digits.find('.');
  if (point == std::string::npos) point = digits.size();
  std::string fraction = point < digits.size() ? digits.substr(point + 1) : std::string{};
  while (fraction.size() < 2) fraction += '0';
  std::string whole = digits.substr(0, point) + fraction.substr(0, 2);
  whole.erase(0, std::min(whole.find_first_not_of('0'), whole.size() - 1));
  fraction.erase(0, 2);
  return whole + (fraction.empty() ? "" : "." + fraction) + "%";
}

std::string time_text(Duration time) {
  struct Unit {
    std::int64_t nanoseconds;
    const char* name;
    std::size_t places;
  };
  constexpr std::array<Unit, 3> kUnits{
      {{1'000'000'000, "s", 9}, {1'000'000, "ms", 6}, {1'000, "us", 3}}};
  const std::int64_t total = time.count();
  if (total == 0) return "0ms";
  for (const Unit& unit : kUnits) {
    if (total < unit.nanoseconds && unit.places > 3) continue;
    std::string fraction = std::to_string(total % unit.nanoseconds);
    fraction.insert(0, unit.places - fraction.size(), '0');
    fraction.erase(fraction.find_last_not_of('0') + 1);
    return std::to_string(total / unit.nanoseconds) + (fraction.empty() ? "" : "." + fraction) +
           unit.name;
  }
  return "0ms";
}

std::string delay_text(const DelayLaw& law) {
  if (law == DelayLaw{}) return {};
  DelayLaw plain;
  plain.mean = law.mean;
  plain.floor = law.floor;
  std::string text = "delay " + time_text(law.mean);
  if (law != plain) text += " " + time_text(law.jitter);
  if (law.correlation > 0) text += " " + share_text(law.correlation);
  if (law.shape == DelayShape::Normal) text += " distribution normal";
  if (law.floor > 0) text += " floor " + share_text(law.floor);
  if (law.correlation_time > Duration{}) {
    text += " correlation-time " + time_text(law.correlation_time);
  }
  return text;
}

std::string gilbert_text(const GilbertLaw& law) {
  if (law == GilbertLaw{}) return {};
  std::string text = "loss gilbert-time " + time_text(law.good) + " " + time_text(law.bad);
  if (law.loss_bad < 1 || law.loss_good > 0) text += " " + share_text(law.loss_bad);
  if (law.loss_good > 0) text += " " + share_text(law.loss_good);
  return text;
}

}  // namespace

std::string to_string(const Impairment& impairment) {
  std::string text;
  const auto add = [&text](const std::string& words) {
    if (!words.empty()) text += (text.empty() ? "" : " ") + words;
  };
  add(delay_text(impairment.delay));
  if (impairment.loss > 0) add("loss " + share_text(impairment.loss));
  if (const BurstLaw& burst = impairment.burst; burst != BurstLaw{}) {
    add("loss burst " + decimal(burst.rate) + "/s " + time_text(burst.length));
  }
  add(gilbert_text(impairment.gilbert));
  if (impairment.duplicate > 0) add("duplicate " + share_text(impairment.duplicate));
  for (const Blackout& blackout : impairment.blackouts) {
    add("blackout " + time_text(blackout.from) + " " + time_text(blackout.length));
  }
  if (impairment.order == Order::Free) add("order free");
  return text.empty() ? "none" : text;
}

Result<Impairment> impairment_from_delay(Duration delay, Duration jitter, double loss) {
  const auto milliseconds = [](Duration span) { return decimal(seconds(span) * 1e3) + " ms"; };
  if (delay < Duration{} || delay > kTimeMax) {
    return fail("delay is " + milliseconds(delay) + ", expected 0 to " + milliseconds(kTimeMax));
  }
  if (jitter < Duration{} || jitter > kTimeMax) {
    return fail("jitter is " + milliseconds(jitter) + ", expected 0 to " + milliseconds(kTimeMax));
  }
  if (!(loss >= 0 && loss <= 1)) {
    return fail("loss is " + std::to_string(loss) + ", expected a share from 0 to 1");
  }
  Impairment impairment;
  impairment.delay.mean = delay;
  if (jitter > Duration{}) {
    impairment.delay.jitter = jitter;
    impairment.delay.shape = DelayShape::Normal;
    impairment.delay.floor = 0.2;
    impairment.order = Order::Free;
  }
  impairment.loss = loss;
  return impairment;
}

Result<Impairment> impairment_from_rtt(Duration rtt, Duration jitter, double loss) {
  return impairment_from_delay(rtt / 2, jitter, loss);
}

}  // namespace palp::netem
