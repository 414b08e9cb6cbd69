#include "study/closed_loop/cue_bank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr double kLineReach = 0.6;  // [-], of levels

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double difference(const FeltTrial& felt, const Judgement& judgement) {
  if (felt.ln_slopes[0].empty() || felt.ln_slopes[1].empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return (mean(felt.ln_slopes[1]) - mean(felt.ln_slopes[0])) / judgement.own_gain;
}

/// At one of the bank's levels.
double share_at(const std::vector<double>& differences, double sd) {
  double sum = 0;
  for (const double one : differences) sum += std::isnan(one) ? 0.5 : normal_cdf(one / sd);
  return sum / static_cast<double>(differences.size());
}

/// The level at which a rising share is `wanted`; infinite beyond the bank.
double level_of(const CueBank& bank, const Judgement& judgement, int taps, double wanted) {
  double low = bank.levels.front();
  double high = bank.levels.back();
  if (banked_share(bank, judgement, taps, high) < wanted) {
    return std::numeric_limits<double>::infinity();
  }
  if (banked_share(bank, judgement, taps, low) > wanted) {
    return -std::numeric_limits<double>::infinity();
  }
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (banked_share(bank, judgement, taps, middle) < wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

CueBank bank_of(const FeltSession& session,
                const Judgement& judgement,
                bool two_sided,
                const std::vector<double>& levels,
                std::size_t count,
                std::uint64_t seed,
                const ForEachIndex& for_each_index) {
  CueBank bank{
      .levels = levels,
      .differences = std::vector<std::vector<double>>(levels.size(), std::vector<double>(count))};
  for_each_index(levels.size() * count, [&](std::size_t i) {
    const std::size_t level = i / count;
    const std::size_t which = i % count;
    // The stronger one comes second in every other session.
    const bool second = two_sided || which % 2 == 0;
    const TrialAsk ask{.level = levels[level], .stronger = second ? 1U : 0U};
    const FeltSetting setting = setting_of(
        ask, two_sided, session.taps(), judgement.depth_sd, random_bits(seed, level, which) >> 16);
    FeltTrial felt = session.feel(setting);
    if (two_sided) felt.ln_slopes[0] = session.touch(setting).ln_slopes[0];
    bank.differences[level][which] = (second ? 1 : -1) * difference(felt, judgement);
  });
  return bank;
}

double banked_share(const CueBank& bank,
                    const Judgement& judgement,
                    int taps,
                    double level) noexcept {
  const double sd = judgement.difference_sd(taps);
  const auto above = std::ranges::lower_bound(bank.levels, level) - bank.levels.begin();
  const auto last = static_cast<std::ptrdiff_t>(bank.levels.size()) - 1;
  const auto right = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above, 1, last));
  const double from = bank.levels[right - 1];
  const double share = std::clamp((level - from) / (bank.levels[right] - from), 0.0, 1.0);
  return (1 - share) * share_at(bank.differences[right - 1], sd) +
         share * share_at(bank.differences[right], sd);
}

Foretold banked(const CueBank& bank, const Judgement& judgement, int taps) {
  const bool two_sided = bank.levels.front() < 0;
  const double upper = level_of(bank, judgement, taps, 0.75);
  if (!two_sided) return {.jnd = upper, .pse = 0};
  return {.jnd = (upper - level_of(bank, judgement, taps, 0.25)) / 2,
          .pse = level_of(bank, judgement, taps, 0.5)};
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
    if (std::abs(level) > kLineReach) continue;
    for (const double one : bank.differences[i]) {
      if (std::isnan(one)) continue;
      count += 1;
      x += level;
      y += one;
      xx += level * level;
      xy += level * one;
      yy += one * one;
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

Foretold closed_form(const FeltLine& line, const Judgement& judgement, int taps) noexcept {
  if (line.gain <= 0) {
    return {.jnd = std::numeric_limits<double>::infinity(),
            .pse = std::numeric_limits<double>::quiet_NaN()};
  }
  return {.jnd = judgement.jnd(taps, line.gain, line.scatter), .pse = -line.offset / line.gain};
}

CueBank resampled(const CueBank& bank, std::uint64_t seed, std::uint64_t stream) {
  CueBank out = bank;
  for (std::size_t level = 0; level < bank.levels.size(); ++level) {
    const std::vector<double>& from = bank.differences[level];
    for (std::size_t i = 0; i < from.size(); ++i) {
      out.differences[level][i] =
          from[random_bits(seed, stream, level * from.size() + i) % from.size()];
    }
  }
  return out;
}

}  // namespace palp::study
