// How well the peer's clock is known, beside what anybody could know:
//   clock_bench errors PRESET|all [LINKS] [SEED]   error of the offset after 20 to 40 s, two Links
//                                                  over the preset, 20 ppm, virtual time
//   clock_bench bounds                             Cramer and Rao's for each preset, after 20 s: of
//                                                  the mean, and for who knows the law of the delay
//                                                  to the last parameter and sees steps of 1 ms
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/random.h"
#include "netem/model/delay_curve.h"
#include "netem/syntax/presets.h"
#include "tests/common/link/network_couple.h"

namespace palp::bench {
namespace {

using link::NetworkCouple;
using link::SiteClock;

constexpr double kSkew = 20e-6;  // [s/s], of every second link the other way
constexpr Duration kSettled = std::chrono::seconds{20};
constexpr int kLooks = 5;
constexpr Duration kLookEvery = std::chrono::seconds{5};

double share_of(const std::vector<double>& sorted, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
  return sorted[std::min(sorted.size() - 1, at)];
}

double us(double span_s) { return span_s * 1e6; }

/// Of the surgeon's estimate, positive: the patient is thought further ahead than it is.
void run_link(const netem::Timeline& preset, std::uint64_t seed, std::vector<double>& errors) {
  const double skew = seed % 2 == 0 ? kSkew : -kSkew;
  NetworkCouple couple{preset.up, preset.down, seed, SiteClock{Duration{0}, skew}};
  // Somewhere in the preset's own time, so that what it does when is met everywhere.
  const double phase = random_middle(random_bits(seed, 77, 0)) * seconds(preset.up.loop);
  couple.now += from_seconds(phase);
  couple.connect(2);
  const TimePoint began = couple.now;
  couple.run(kSettled);
  for (int look = 0; look < kLooks; ++look) {
    if (look > 0) couple.run(kLookEvery);
    const auto& clock = couple.surgeon.health.peer_clock;
    if (!clock) continue;
    const double truth = skew * seconds(couple.now - began);
    errors.push_back(seconds(clock->offset_at(couple.now)) - truth);
  }
}

void show_errors(const std::string& name, std::uint64_t links, std::uint64_t seed) {
  const auto preset = netem::find_preset(name);
  if (!preset) {
    std::printf("%s\n", preset.error().text.c_str());
    return;
  }
  std::vector<double> errors;
  for (std::uint64_t i = 0; i < links; ++i) run_link(*preset, seed + i, errors);
  if (errors.empty()) {
    std::printf("%-16s no estimate\n", name.c_str());
    return;
  }
  std::sort(errors.begin(), errors.end());
  const double middle = share_of(errors, 0.5);
  std::vector<double> size;
  std::vector<double> about;
  for (const double error : errors) {
    size.push_back(std::abs(error));
    about.push_back(std::abs(error - middle));
  }
  std::sort(size.begin(), size.end());
  std::sort(about.begin(), about.end());
  std::printf(
      "%-16s p50 %6.0f  p90 %6.0f  p99 %6.0f us   middle %+6.0f, about it p50 %6.0f  p99 %6.0f "
      "us\n",
      name.c_str(),
      us(share_of(size, 0.5)),
      us(share_of(size, 0.9)),
      us(share_of(size, 0.99)),
      us(middle),
      us(share_of(about, 0.5)),
      us(share_of(about, 0.99)));
  std::fflush(stdout);
}

/// What one way's delays tell of where their law lies.
struct Bound {
  double by_law{};   ///< [s], sd of who knows the law but for its place, from steps of 1 ms
  double by_mean{};  ///< [s], sd of the mean
};

/// Of T seconds. The delay is x(z) of a standard normal z that remembers itself for `memory`; from
/// z' = a z + s e follows the score of a shift, (e/s) (1/x'(z') - a/x'(z)) + x''(z') / x'(z')^2.
Bound bound_of(const netem::DelayLaw& law, double memory, double span) {
  const netem::DelayCurve curve{law};
  const double scale = curve.jitter() * 1e-9;
  const auto x = [&](double z) { return scale * curve.at_normal(z); };
  constexpr double kStep = 1e-3;
  const double a = std::exp(-kStep / memory);
  const double s = std::sqrt(1 - a * a);
  constexpr double kH = 0.02;
  double information = 0;
  double mean = 0;
  constexpr std::uint64_t kDraws = 2'000'000;
  double z = 0;
  for (std::uint64_t n = 0; n < kDraws; ++n) {
    const double e = random_normal(5, 1, n);
    const double next = a * z + s * e;
    const auto first = [&](double at) { return (x(at + kH) - x(at - kH)) / (2 * kH); };
    const double slope = first(next);
    const double bend = (x(next + kH) - 2 * x(next) + x(next - kH)) / (kH * kH);
    const double score = e / s * (1 / slope - a / first(z)) + bend / (slope * slope);
    information += score * score / kDraws;
    mean += x(next) / kDraws;
    z = next;
  }
  // The mean's: the correlation of x at each lag, of drawn pairs.
  constexpr std::uint64_t kPairs = 20'000;
  constexpr int kLags = 60;
  const double reach = 6 * memory;
  double integral = 0;
  for (int k = 0; k < kLags; ++k) {
    const double r = std::exp(-(k + 0.5) / kLags * reach / memory);
    double product = 0;
    for (std::uint64_t n = 0; n < kPairs; ++n) {
      const double one = random_normal(6, 1, n);
      const double two = r * one + std::sqrt(1 - r * r) * random_normal(6, 2, n);
      product += (x(one) - mean) * (x(two) - mean);
    }
    integral += product / kPairs * reach / kLags;
  }
  return {.by_law = 1 / std::sqrt(information * span / kStep),
          .by_mean = std::sqrt(2 * integral / span)};
}

void show_bounds(const std::string& name) {
  const auto preset = netem::find_preset(name);
  if (!preset) return;
  constexpr double kSpan = 20;
  const auto of = [&](const netem::PathPlan& plan) {
    const netem::Impairment& impairment =
        plan.changes.empty() || plan.impairment.delay.jitter > Duration{0}
            ? plan.impairment
            : plan.changes.front().impairment;
    return bound_of(impairment.delay, seconds(impairment.delay.correlation_time), kSpan);
  };
  const Bound up = of(preset->up);
  const Bound down = of(preset->down);
  // Half the difference of both ways, and at the end of a line of unknown slope twice that.
  const double by_law = std::hypot(up.by_law, down.by_law);
  const double by_mean = std::hypot(up.by_mean, down.by_mean);
  std::printf("%-16s the mean: p50 %6.0f  p99 %6.0f us",
              name.c_str(),
              us(0.6745 * by_mean),
              us(2.576 * by_mean));
  if (std::isfinite(by_law)) {
    std::printf("; the whole law known: p50 %6.0f  p99 %6.0f us\n",
                us(0.6745 * by_law),
                us(2.576 * by_law));
  } else {
    std::printf("; the whole law known: no bound, it has an edge where it is densest\n");
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  const std::string wanted = argc > 2 ? argv[2] : "all";
  const std::uint64_t links = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 20;
  const std::uint64_t seed = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1;
  for (const std::string& name : palp::netem::preset_names()) {
    if (wanted != "all" && ("," + wanted + ",").find("," + name + ",") == std::string::npos)
      continue;
    if (what == "bounds") {
      palp::bench::show_bounds(name);
    } else {
      palp::bench::show_errors(name, links, seed);
    }
  }
  return 0;
}
