#include "study/closed_loop/cue_bank.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/random.h"
#include "study/orders.h"

namespace palp::study {
namespace {

constexpr double kLineReach = 0.6;  // [-], of levels

/// [-], of a trial; none where an interval told nothing.
CueBank::Differences differences(const FeltTrial& felt,
                                 const Task& task,
                                 const Judgement& judgement,
                                 std::size_t stronger) {
  std::vector<double> left;
  for (const FeltInterval& one : felt.intervals) {
    const auto impressed = impression(one, judgement);
    if (!impressed) return {};
    left.push_back(*impressed);
  }
  if (task.yes_no) return {left.front() - judgement.plain};
  if (task.ranks) {
    const Order& order = kOrders[stronger];
    return {left[order[1]] - left[order[0]], left[order[2]] - left[order[1]]};
  }
  CueBank::Differences out;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (i != stronger) out.push_back(left[stronger] - left[i]);
  }
  return out;
}

/// What is told apart of a session.
double share_of(const CueBank::Differences& session,
                const Task& task,
                const Judgement& judgement,
                double sd) {
  if (session.empty()) return chance(task);
  // Without noise the same is the same.
  if (sd == 0 && std::ranges::count(session, 0.0) > 0) return task.yes_no ? 0 : chance(task);
  if (task.yes_no) return normal_cdf(session.front() / sd - judgement.criterion);
  if (task.ranks) return order_share(session[0] / sd, session[1] / sd);
  std::vector<double> d_primes;
  for (const double one : session) d_primes.push_back(one / sd);
  return forced_choice_share(d_primes);
}

/// The least level at which the share rises above `wanted`; infinite beyond the bank. Where an
/// interval told nothing the share is a guess's, which may well be above it: that is no rise.
double level_of(const CueBank& bank, const Judgement& judgement, int taps, double wanted) {
  double before = banked_share(bank, judgement, taps, bank.levels.front());
  bool below = before < wanted;
  for (std::size_t i = 1; i < bank.levels.size(); ++i) {
    const double from = bank.levels[i - 1];
    const double share = banked_share(bank, judgement, taps, bank.levels[i]);
    if (before < wanted && share >= wanted) {
      return from + (bank.levels[i] - from) * (wanted - before) / (share - before);
    }
    below = below || share < wanted;
    before = share;
  }
  const double beyond = std::numeric_limits<double>::infinity();
  return below ? beyond : -beyond;
}

}  // namespace

CueBank bank_of(const FeltSession& session,
                const Judgement& judgement,
                const Task& task,
                const std::vector<double>& levels,
                std::size_t count,
                std::uint64_t seed,
                const ForEachIndex& for_each_index) {
  CueBank bank{.task = task,
               .levels = levels,
               .differences = std::vector<std::vector<CueBank::Differences>>(
                   levels.size(), std::vector<CueBank::Differences>(count))};
  const std::size_t answers = choices(task);
  for_each_index(levels.size() * count, [&](std::size_t i) {
    const std::size_t level = i / count;
    const std::size_t which = i % count;
    // The stronger one takes turns.
    const std::size_t stronger = task.two_sided ? 1 : answers - 1 - which % answers;
    const TrialAsk ask{.level = levels[level], .stronger = stronger};
    const FeltSetting setting = setting_of(
        ask, task, session.taps(), judgement.depth_sd, random_bits(seed, level, which) >> 16);
    bank.differences[level][which] =
        differences(feel_trial(session, setting, task), task, judgement, stronger);
  });
  return bank;
}

double banked_share(const CueBank& bank,
                    const Judgement& judgement,
                    int taps,
                    double level) noexcept {
  const double sd = judgement.sd(taps);
  const auto share_at = [&](std::size_t index) {
    double sum = 0;
    for (const CueBank::Differences& one : bank.differences[index]) {
      sum += share_of(one, bank.task, judgement, sd);
    }
    return sum / static_cast<double>(bank.differences[index].size());
  };
  const auto above = std::ranges::lower_bound(bank.levels, level) - bank.levels.begin();
  const auto last = static_cast<std::ptrdiff_t>(bank.levels.size()) - 1;
  const auto right = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above, 1, last));
  const double from = bank.levels[right - 1];
  const double share = std::clamp((level - from) / (bank.levels[right] - from), 0.0, 1.0);
  return (1 - share) * share_at(right - 1) + share * share_at(right);
}

Foretold banked(const CueBank& bank, const Judgement& judgement, int taps) {
  const double upper = level_of(bank, judgement, taps, (1 + chance(bank.task)) / 2);
  if (!bank.task.two_sided) return {.jnd = upper, .pse = 0};
  if (std::isinf(upper)) return {.jnd = upper, .pse = std::numeric_limits<double>::quiet_NaN()};
  const double pse = level_of(bank, judgement, taps, 0.5);
  // Below what nothing feels like there are no levels.
  if (bank.task.yes_no) return {.jnd = upper - pse, .pse = pse};
  return {.jnd = (upper - level_of(bank, judgement, taps, 0.25)) / 2, .pse = pse};
}

FeltLine line_of(const CueBank& bank) {
  double count = 0;
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (std::size_t i = 0; i < bank.levels.size(); ++i) {
    const double level = bank.levels[i];
    if (std::abs(level) > kLineReach * level_unit(bank.task)) continue;
    for (const CueBank::Differences& session : bank.differences[i]) {
      for (const double one : session) {
        count += 1;
        x += level;
        y += one;
        xx += level * level;
        xy += level * one;
        yy += one * one;
      }
    }
  }
  const double spread = count * xx - x * x;
  if (spread <= 1e-9 * count * count) return {};
  const double gain = (count * xy - x * y) / spread;
  const double left = (yy - y * y / count) - gain * (xy - x * y / count);
  return {.gain = gain,
          .offset = (y - gain * x) / count,
          .scatter = std::sqrt(std::max(0.0, left) / std::max(1.0, count - 2))};
}

Foretold closed_form(const FeltLine& line,
                     const Task& task,
                     const Judgement& judgement,
                     int taps) noexcept {
  if (line.gain <= 0) {
    return {.jnd = std::numeric_limits<double>::infinity(),
            .pse = std::numeric_limits<double>::quiet_NaN()};
  }
  const double from = task.yes_no ? judgement.criterion * judgement.sd(taps) : 0;
  return {.jnd = judgement.jnd(task, taps, line.gain, line.scatter),
          .pse = (from - line.offset) / line.gain};
}

CueBank resampled(const CueBank& bank, std::uint64_t seed, std::uint64_t stream) {
  CueBank out = bank;
  for (std::size_t level = 0; level < bank.levels.size(); ++level) {
    const auto& from = bank.differences[level];
    for (std::size_t i = 0; i < from.size(); ++i) {
      out.differences[level][i] =
          from[random_bits(seed, stream, level * from.size() + i) % from.size()];
    }
  }
  return out;
}

}  // namespace palp::study
