#include "netem/simulation.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace palp::netem {
namespace {

/// As many as tc's limit can say where people ask for many; the memory is used as it is needed.
constexpr std::size_t kInFlightMax = 1'000'000;

/// Counts as the decisions come, without keeping any.
class Account {
 public:
  void add(std::span<const Decision> decisions) noexcept {
    const Decision& original = decisions.front();
    ++result.verdicts[static_cast<std::size_t>(original.verdict)];
    result.copies += decisions.size() - 1;
    if (original.verdict != Verdict::Delivered) {
      result.loss_runs += lost_before_ ? 0 : 1;
      lost_before_ = true;
      return;
    }
    lost_before_ = false;
    result.corrupted += original.flipped_bit >= 0 ? 1 : 0;
    result.floored += original.floored ? 1 : 0;
    result.intended.record(original.intended);
  }
  void leaves(const Decision& decision) noexcept {
    if (decision.copy > 0) return;
    result.delay.record(decision.released_at - decision.arrived_at);
    if (decision.index < next_) ++result.reordered;
    next_ = std::max(next_, decision.index + 1);
  }
  SimulationResult result;

 private:
  bool lost_before_{};
  std::uint64_t next_{};
};

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
  Passage passage{config.plan, config.seed, config.direction, kInFlightMax, kInFlightMax, {}};
  Account account;
  DecisionOrder order{each};
  const std::size_t payload =
      config.frame_length > kFrameHeaders ? config.frame_length - kFrameHeaders : 0;
  const auto collect = [&](TimePoint now) {
    while (const auto left = passage.pop(now)) {
      account.leaves(*left);
      if (each && !passage.decides_at_once()) order.left(*left);
    }
  };
  const std::uint64_t burst = std::max<std::uint64_t>(config.burst, 1);
  const Duration step = config.interval * static_cast<std::int64_t>(burst);
  TimePoint at{};
  for (std::uint64_t k = 0; k < config.packets;) {
    for (const std::uint64_t end = std::min(k + burst, config.packets); k < end; ++k) {
      const auto decisions = passage.push({.at = at, .length = payload, .room = kInFlightMax});
      account.add(decisions);
      if (each) order.decided(decisions, passage.decides_at_once());
    }
    collect(at);
    at += step;
  }
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
