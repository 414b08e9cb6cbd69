#include "netem/model/impairment.h"

#include <algorithm>
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

std::string shape_name(const DelayLaw& law) {
  switch (law.shape) {
    case DelayShape::Uniform:
      return "uniform";
    case DelayShape::Normal:
      return "normal";
    case DelayShape::Pareto:
      return "pareto";
    case DelayShape::ParetoNormal:
      return "paretonormal";
    case DelayShape::Gamma:
      return "gamma";
    case DelayShape::LogNormal:
      return "lognormal";
    case DelayShape::Table:
      return law.table.name;
    case DelayShape::Histogram:
      return law.histogram.name;
  }
  return {};
}

std::string delay_text(const DelayLaw& law) {
  if (law == DelayLaw{}) return {};
  std::string text;
  if (law.shape == DelayShape::Histogram) {
    text = "histogram " + law.histogram.name;
  } else {
    DelayLaw plain;
    plain.mean = law.mean;
    plain.floor = law.floor;
    text = "delay " + time_text(law.mean);
    if (law != plain) text += " " + time_text(law.jitter);
    if (law.correlation > 0) text += " " + share_text(law.correlation);
    if (law.shape != DelayShape::Uniform) text += " distribution " + shape_name(law);
  }
  if (law.floor > 0) text += " floor " + share_text(law.floor);
  if (law.correlation_time > Duration{}) {
    text += " correlation-time " + time_text(law.correlation_time);
  }
  return text;
}

std::string chance_text(const Chance& chance) {
  std::string text = share_text(chance.share);
  if (chance.correlation > 0) text += " " + share_text(chance.correlation);
  return text;
}

/// Adds the clauses with a blank between.
class Clauses {
 public:
  void add(const std::string& words) {
    if (!words.empty()) text_ += (text_.empty() ? "" : " ") + words;
  }
  void add_chance(const char* clause, const Chance& chance, const std::string& more = {}) {
    if (chance != Chance{}) add(clause + chance_text(chance) + more);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add_losses(Clauses& clauses, const Impairment& impairment) {
  clauses.add_chance("loss ", impairment.loss);
  if (const auto& law = impairment.state) {
    clauses.add("loss state " + share_text(law->p13) + " " + share_text(law->p31) + " " +
                share_text(law->p32) + " " + share_text(law->p23) + " " + share_text(law->p14));
  }
  if (const auto& law = impairment.gemodel) {
    clauses.add("loss gemodel " + share_text(law->to_bad) + " " + share_text(law->to_good) + " " +
                share_text(law->loss_bad) + " " + share_text(law->loss_good));
  }
  if (const BurstLaw& burst = impairment.burst; burst != BurstLaw{}) {
    clauses.add("loss burst " + decimal(burst.rate) + "/s " + time_text(burst.length));
  }
  if (const GilbertLaw& law = impairment.gilbert; law != GilbertLaw{}) {
    std::string text = "loss gilbert-time " + time_text(law.good) + " " + time_text(law.bad);
    if (law.loss_bad < 1 || law.loss_good > 0) text += " " + share_text(law.loss_bad);
    if (law.loss_good > 0) text += " " + share_text(law.loss_good);
    clauses.add(text);
  }
  if (!impairment.bitmap.lost.empty()) clauses.add("loss bitmap " + impairment.bitmap.name);
  if (impairment.ecn) clauses.add("ecn");
}

void add_line(Clauses& clauses, const Impairment& impairment) {
  if (const RateLaw& law = impairment.rate; law.bytes_per_s > 0) {
    clauses.add("rate " + std::to_string(law.bytes_per_s) + "bps " + std::to_string(law.overhead) +
                " " + std::to_string(law.cell) + " " + std::to_string(law.cell_overhead));
  }
  if (const QueueLaw& law = impairment.queue; law != QueueLaw{}) {
    std::string text = "queue";
    if (law.packets > 0) text += " packets " + std::to_string(law.packets);
    if (law.bytes > 0) text += " bytes " + std::to_string(law.bytes);
    if (law.wait > Duration{}) text += " time " + time_text(law.wait);
    if (law.codel) {
      text += " codel target " + time_text(law.target) + " interval " + time_text(law.interval);
    }
    clauses.add(text);
  }
  if (const SlotLaw& law = impairment.slot; law != SlotLaw{}) {
    std::string text = "slot " + time_text(law.min) + " " + time_text(law.max);
    if (law.spacing) {
      text = "slot distribution " + shape_name(*law.spacing) + " " + time_text(law.spacing->mean) +
             " " + time_text(law.spacing->jitter);
    }
    if (law.packets > 0) text += " packets " + std::to_string(law.packets);
    if (law.bytes > 0) text += " bytes " + std::to_string(law.bytes);
    clauses.add(text);
  }
  if (impairment.limit > 0) clauses.add("limit " + std::to_string(impairment.limit));
  if (impairment.mtu > 0) clauses.add("mtu " + std::to_string(impairment.mtu));
}

void add_order(Clauses& clauses, const Impairment& impairment) {
  const Order usual =
      impairment.mode == Mode::Exact && impairment.replay.rows.empty() ? Order::Keep : Order::Netem;
  if (impairment.order == usual) return;
  if (impairment.order == Order::Keep) clauses.add("order keep");
  if (impairment.order == Order::Netem) clauses.add("order netem");
  if (impairment.order == Order::Swap) {
    clauses.add("order swap " + chance_text(impairment.swap) + " depth " +
                std::to_string(impairment.swap_depth));
  }
}

}  // namespace

std::string to_string(const Impairment& impairment) {
  Clauses clauses;
  clauses.add(delay_text(impairment.delay));
  if (const DelayTrace& trace = impairment.trace; !trace.points.empty()) {
    clauses.add("trace " + trace.name + (trace.loop ? " loop" : "") +
                (trace.dither ? " dither" : ""));
  }
  if (!impairment.replay.rows.empty()) clauses.add("replay " + impairment.replay.name);
  add_losses(clauses, impairment);
  clauses.add_chance("duplicate ", impairment.duplicate);
  if (impairment.corrupt != Chance{} || impairment.corrupt_payload) {
    clauses.add("corrupt " + chance_text(impairment.corrupt) +
                (impairment.corrupt_payload ? " payload" : ""));
  }
  if (impairment.truncate != Chance{} || impairment.truncate_to > 0) {
    clauses.add("truncate " + chance_text(impairment.truncate) + " to " +
                std::to_string(impairment.truncate_to));
  }
  if (const ReorderLaw& law = impairment.reorder; law != ReorderLaw{}) {
    clauses.add("reorder " + chance_text(law.chance) + " gap " + std::to_string(law.gap));
  }
  add_line(clauses, impairment);
  if (const StallLaw& law = impairment.stall; law != StallLaw{}) {
    clauses.add("stall " + decimal(law.rate) + "/s " + time_text(law.median) + " " +
                decimal(law.spread));
  }
  for (const Blackout& blackout : impairment.blackouts) {
    clauses.add("blackout " + time_text(blackout.from) + " " + time_text(blackout.length));
  }
  if (impairment.dscp_clear) clauses.add("dscp-clear");
  add_order(clauses, impairment);
  const std::string mode = impairment.mode == Mode::Netem61 ? "mode netem-6.1 " : "";
  return mode + (clauses.text().empty() ? "none" : clauses.text());
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
    impairment.order = Order::Netem;
  }
  impairment.loss.share = loss;
  return impairment;
}

Result<Impairment> impairment_from_rtt(Duration rtt, Duration jitter, double loss) {
  return impairment_from_delay(rtt / 2, jitter, loss);
}

}  // namespace palp::netem
