#include "netem/simulation.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <vector>

#include "netem/occupancy.h"

namespace palp::netem {
namespace {

/// As many as tc's limit can say where people ask for many; the memory is used as it is needed.
constexpr std::size_t kInFlightMax = 1'000'000;

/// With so many, the quantiles of every eighth delay are as good.
constexpr std::uint64_t kManyPackets = 100'000;
constexpr std::uint64_t kEighth = 7;  ///< mask of a count

/// Counts as the decisions come, without keeping any.
class Account {
 public:
  /// The delays whose number has none of the bits of `mask` go into the histograms. A remainder
  /// would cost as much as the decision.
  explicit Account(std::uint64_t mask) : mask_{mask} {}

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
  SimulationResult result;

 private:
  std::uint64_t mask_;
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
  for (std::uint64_t k = 0; k < config.packets; at += step) {
    for (const std::uint64_t end = std::min(k + burst, config.packets); k < end; ++k) judge(at);
    pause(at);
  }
}

std::size_t payload_of(const SimulationConfig& config) {
  return config.frame_length > kFrameHeaders ? config.frame_length - kFrameHeaders : 0;
}

/// Where only sums are wanted and nothing changes on the way, nobody need be held in order: how
/// many are on their way is enough. The fates are the same.
SimulationResult sums(const SimulationConfig& config) {
  const Impairment& law = config.plan.impairment;
  FateSequence fates{law, config.seed, config.direction, TimePoint{}};
  Occupancy occupancy{std::min(limit_of(law), kInFlightMax)};
  Account account{config.packets >= kManyPackets ? kEighth : 0};
  Arrival arrival{.length = payload_of(config)};
  const Duration tie{law.mode == Mode::Netem61 ? 1 : 0};
  send_all(
      config,
      [&](TimePoint at) {
        arrival.at = at;
        arrival.room = occupancy.room(at - tie, kCopiesMax);
        const auto copies = fates.next(arrival);
        const CopyFate& original = copies.front();
        account.add(original.verdict,
                    original.flipped_bit >= 0,
                    original.floored,
                    original.delay,
                    copies.size() - 1);
        for (const CopyFate& copy : copies) {
          if (copy.verdict == Verdict::Delivered) occupancy.enter(copy.release);
        }
        if (original.verdict == Verdict::Delivered) account.leaves(at, original.release);
      },
      [](TimePoint) {});
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

void DecisionOrder::decided(std::span<const Decision> decisions, bool final) {
  if (final && waiting_.empty()) {
    for (const Decision& decision : decisions) sink_(decision);
    return;
  }
  Datagram datagram;
  datagram.count = decisions.size();
  std::copy(decisions.begin(), decisions.end(), datagram.copies.begin());
  if (!final) {
    datagram.open = static_cast<std::size_t>(
        std::count_if(decisions.begin(), decisions.end(), [](const Decision& decision) {
          return decision.verdict == Verdict::Delivered;
        }));
  }
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
  Passage passage{config.plan, config.seed, config.direction, kInFlightMax, kInFlightMax, {}};
  Account account{0};
  DecisionOrder order{[&](const Decision& decision) {
    if (decision.copy == 0 && decision.verdict == Verdict::Delivered) {
      account.leaves(decision.arrived_at, decision.released_at);
    }
    if (each) each(decision);
  }};
  const std::size_t payload = payload_of(config);
  const auto collect = [&](TimePoint now) {
    while (const auto left = passage.pop(now)) {
      if (!passage.decides_at_once()) order.left(*left);
    }
  };
  send_all(
      config,
      [&](TimePoint at) {
        const auto decisions = passage.push({.at = at, .length = payload, .room = kInFlightMax});
        const Decision& original = decisions.front();
        account.add(original.verdict,
                    original.flipped_bit >= 0,
                    original.floored,
                    original.intended,
                    decisions.size() - 1);
        order.decided(decisions, passage.decides_at_once());
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
