#include "netem/model/simulation.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <vector>

#include "netem/model/occupancy.h"

namespace palp::netem {
namespace {

constexpr std::size_t kInFlightMax = 4'000'000;

/// Room for all, each with its duplicate, up to a bound; the memory is used as it is needed.
std::size_t in_flight_max(const SimulationConfig& config) {
  return std::min<std::uint64_t>(2 * std::min<std::uint64_t>(config.packets, kInFlightMax) + 1,
                                 kInFlightMax);
}

/// With so many, the quantiles of every eighth delay are as good.
constexpr std::uint64_t kManyPackets = 100'000;
constexpr std::uint64_t kEighth = 7;  ///< mask of a count

/// Counts as the decisions come, without keeping any.
class Account {
 public:
  /// The delays whose number has none of the bits of `mask` go into the histograms. A remainder
  /// would cost as much as the decision. `overtaken`: somebody may be, so it is looked for.
  Account(std::uint64_t mask, bool overtaken) : mask_{mask}, overtaken_{overtaken} {}

  /// The original of the next datagram, and how many copies came with it.
  void add(Verdict verdict, bool corrupted, bool floored, Duration intended, std::size_t copies) {
    ++result.verdicts[static_cast<std::size_t>(verdict)];
    result.copies += copies;
    if (verdict != Verdict::Delivered) {
      result.loss_runs += lost_before_ ? 0 : 1;
      lost_before_ = true;
      return;
    }
    lost_before_ = false;
    result.corrupted += corrupted ? 1 : 0;
    result.floored += floored ? 1 : 0;
    if ((++counted_ & mask_) == 0) result.intended.record(intended);
  }
  /// An original that came at `at` leaves at `release`; in the order they came.
  void leaves(TimePoint at, TimePoint release) {
    if ((++left_ & mask_) == 0) result.delay.record(release - at);
    if (overtaken_) look_back(at, release);
  }
  SimulationResult result;

 private:
  void look_back(TimePoint at, TimePoint release) {
    // Those ahead that leave later are overtaken, once each (RFC 4737); who has left cannot be.
    while (pending_.size() > first_ && pending_.back() > release) {
      pending_.pop_back();
      ++result.reordered;
    }
    while (first_ < pending_.size() && pending_[first_] <= at) ++first_;
    if (first_ > 1024 && 2 * first_ > pending_.size()) {
      pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(first_));
      first_ = 0;
    }
    pending_.push_back(release);
  }

  std::uint64_t mask_;
  bool overtaken_;
  std::uint64_t counted_{};
  std::uint64_t left_{};
  bool lost_before_{};
  std::vector<TimePoint> pending_;  ///< rising releases of those not overtaken, from first_ on
  std::size_t first_{};
};

/// Calls `judge` with the time of each datagram and `pause` between the bunches.
template <class Judge, class Pause>
void send_all(const SimulationConfig& config, Judge&& judge, Pause&& pause) {
  const std::uint64_t burst = std::max<std::uint64_t>(config.burst, 1);
  const Duration step = config.interval * static_cast<std::int64_t>(burst);
  TimePoint at{};
  std::uint64_t in_bunch = 0;
  for (std::uint64_t k = 0; k < config.packets; ++k) {
    judge(at);
    if (++in_bunch < burst) continue;
    pause(at);
    at += step;
    in_bunch = 0;
  }
  if (in_bunch > 0) pause(at);
}

std::size_t payload_of(const SimulationConfig& config) {
  return config.frame_length > kFrameHeaders ? config.frame_length - kFrameHeaders : 0;
}

/// Where only sums are wanted and nothing changes on the way, nobody need be held in order: how
/// many are on their way is enough. The outcomes are the same.
SimulationResult sums(const SimulationConfig& config) {
  const Impairment& law = config.plan.impairment;
  ImpairmentModel outcomes{law, config.seed, config.direction, TimePoint{}};
  const std::size_t most = in_flight_max(config);
  const bool crowded = limit_of(law) < most || most == kInFlightMax;
  Occupancy occupancy{std::min(limit_of(law), most)};
  Account account{config.packets >= kManyPackets ? kEighth : 0, may_overtake(law)};
  Arrival arrival{.length = payload_of(config), .room = kCopiesMax};
  const Duration tie{law.mode == Mode::Netem61 ? 1 : 0};  // see ImpairedPath::settle()
  outcomes.with_model([&](auto& judge) {
    send_all(
        config,
        [&](TimePoint at) {
          const TimePoint gone = at == arrival.at ? at : at - tie;
          arrival.at = at;
          if (crowded) arrival.room = occupancy.room(gone, kCopiesMax);
          const auto copies = judge.next(arrival);
          const CopyOutcome& original = copies.front();
          account.add(original.verdict,
                      original.flipped_bit >= 0,
                      original.floored,
                      original.delay,
                      copies.size() - 1);
          if (crowded) {
            for (const CopyOutcome& copy : copies) {
              if (copy.verdict == Verdict::Delivered) occupancy.enter(copy.release);
            }
          }
          if (original.verdict == Verdict::Delivered) account.leaves(at, original.release);
        },
        [](TimePoint) {});
  });
  return account.result;
}

double milliseconds(Duration span) { return static_cast<double>(span.count()) * 1e-6; }

std::string percent(std::uint64_t part, std::uint64_t whole) {
  char text[32];
  const double share = whole > 0 ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0;
  std::snprintf(text, sizeof text, "%.4g %%", share);
  return text;
}

template <class Number>
void append(std::string& text, Number number) {
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  text.append(digits.data(), end.ptr);
}

}  // namespace

void DecisionOrder::decided(std::span<const Decision> decisions) {
  const auto open = std::count_if(
      decisions.begin(), decisions.end(), [](const Decision& decision) { return decision.open; });
  if (open == 0 && waiting_.empty()) {
    for (const Decision& decision : decisions) sink_(decision);
    return;
  }
  Datagram datagram;
  datagram.count = decisions.size();
  std::copy(decisions.begin(), decisions.end(), datagram.copies.begin());
  datagram.open = static_cast<std::size_t>(open);
  waiting_.emplace(decisions.front().index, datagram);
  flush();
}

void DecisionOrder::left(const Decision& decision) {
  const auto found = waiting_.find(decision.index);
  if (found == waiting_.end()) return;
  found->second.copies[decision.copy] = decision;
  if (found->second.open > 0) --found->second.open;
  flush();
}

std::uint64_t DecisionOrder::give_up(std::size_t count) {
  std::uint64_t open = 0;
  for (; count > 0 && !waiting_.empty(); --count) {
    open += waiting_.begin()->second.open;
    waiting_.begin()->second.open = 0;
    flush();
  }
  return open;
}

void DecisionOrder::flush() {
  while (!waiting_.empty() && waiting_.begin()->second.open == 0) {
    const Datagram& datagram = waiting_.begin()->second;
    for (std::size_t i = 0; i < datagram.count; ++i) sink_(datagram.copies[i]);
    waiting_.erase(waiting_.begin());
  }
}

SimulationResult simulate(const SimulationConfig& config, const DecisionOrder::Sink& each) {
  const Impairment& law = config.plan.impairment;
  const bool kernel_slots = law.mode == Mode::Netem61 && law.slot.max > Duration{};
  if (!each && config.plan.changes.empty() && !kernel_slots) return sums(config);
  const std::size_t most = in_flight_max(config);
  ImpairedPath impaired_path{config.plan, config.seed, config.direction, most, most, {}};
  Account account{0, true};
  DecisionOrder order{[&](const Decision& decision) {
    if (decision.copy == 0 && decision.verdict == Verdict::Delivered) {
      account.leaves(decision.arrived_at, decision.released_at);
    }
    if (each) each(decision);
  }};
  const std::size_t payload = payload_of(config);
  const auto collect = [&](TimePoint now) {
    while (const auto left = impaired_path.pop(now)) {
      if (left->open) order.left(*left);
    }
  };
  send_all(
      config,
      [&](TimePoint at) {
        const auto decisions = impaired_path.push({.at = at, .length = payload, .room = most});
        const Decision& original = decisions.front();
        account.add(original.verdict,
                    original.flipped_bit >= 0,
                    original.floored,
                    original.intended,
                    decisions.size() - 1);
        order.decided(decisions);
      },
      collect);
  collect(TimePoint::max());
  return account.result;
}

void append_recording_line(std::string& text, const Decision& decision, TimePoint start) {
  append(text, decision.index);
  text += ',';
  append(text, (decision.arrived_at - start).count());
  text += ',';
  if (decision.verdict == Verdict::Delivered) append(text, (decision.released_at - start).count());
  text += ',';
  append(text, decision.copy);
  text += ',';
  text += kVerdictNames[static_cast<std::size_t>(decision.verdict)];
  text += ',';
  if (decision.flipped_bit >= 0) append(text, decision.flipped_bit);
}

std::string to_string(const SimulationResult& result) {
  std::uint64_t packets = 0;
  for (const std::uint64_t count : result.verdicts) packets += count;
  const auto count = [&](Verdict verdict) {
    return result.verdicts[static_cast<std::size_t>(verdict)];
  };
  const std::uint64_t missing = packets - count(Verdict::Delivered);
  char text[600];
  std::snprintf(text,
                sizeof text,
                "sent %llu, delivered %llu, lost %llu (%s, mean run %.3f), header_hit %llu, "
                "over_limit %llu, blackout %llu\n"
                "duplicated %llu, corrupted %llu, reordered %llu (%s), lifted to the floor %llu\n"
                "delay p1 %.3f, p50 %.3f, p99 %.3f, mean %.3f ms; intended mean %.3f ms\n",
                static_cast<unsigned long long>(packets),
                static_cast<unsigned long long>(count(Verdict::Delivered)),
                static_cast<unsigned long long>(count(Verdict::Lost)),
                percent(count(Verdict::Lost), packets).c_str(),
                result.loss_runs > 0
                    ? static_cast<double>(missing) / static_cast<double>(result.loss_runs)
                    : 0,
                static_cast<unsigned long long>(count(Verdict::HeaderHit)),
                static_cast<unsigned long long>(count(Verdict::OverLimit)),
                static_cast<unsigned long long>(count(Verdict::Blackout)),
                static_cast<unsigned long long>(result.copies),
                static_cast<unsigned long long>(result.corrupted),
                static_cast<unsigned long long>(result.reordered),
                percent(result.reordered, count(Verdict::Delivered)).c_str(),
                static_cast<unsigned long long>(result.floored),
                milliseconds(result.delay.quantile(0.01)),
                milliseconds(result.delay.quantile(0.5)),
                milliseconds(result.delay.quantile(0.99)),
                milliseconds(result.delay.mean()),
                milliseconds(result.intended.mean()));
  return text;
}

}  // namespace palp::netem
