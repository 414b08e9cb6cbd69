// What a decision costs beside a plain draw, alternating in one run:
//   netem_decision_bench [ROUNDS]
// A draw is random_bits(seed, stream, index); a decision is a datagram of `palp-netem
// simulate` without CSV. Printed: the medians of a million of each, and of their ratios.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "common/core/random.h"
#include "common/io/process/process_time.h"
#include "netem/model/simulation.h"
#include "tests/netem/model/impairment_builders.h"

namespace palp::bench {
namespace {

constexpr std::uint64_t kCount = 1'000'000;

constexpr std::array kCombinations{
    "delay 50ms",
    "delay 50ms 10ms 25% distribution normal loss 10% 25% duplicate 1% 10% corrupt 1% 10%",
    "delay 50ms 10ms 25% distribution pareto loss 10% 25% duplicate 1% 10% corrupt 1% 10% "
    "reorder 5% 25% rate 1gbit",
    "delay 50ms 10ms distribution gamma correlation-time 40ms loss gilbert-time 1s 20ms "
    "duplicate 1% 10% corrupt 1% 10% reorder 5% 25% rate 1gbit slot 1ms 2ms",
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double draw_seconds() {
  const Duration from = io::process_time().wall;
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) sum ^= random_bits(1, 2, i);
  if (sum == 0) std::puts("");  // keeps the draws
  return seconds(io::process_time().wall - from);
}

double decision_seconds(const netem::SimulationConfig& config) {
  const Duration from = io::process_time().wall;
  if (netem::simulate(config, {}).verdicts[0] == 0) std::puts("");
  return seconds(io::process_time().wall - from);
}

void compare(const char* words, int rounds) {
  netem::SimulationConfig config{.packets = kCount, .interval = std::chrono::milliseconds{1}};
  config.plan.impairment = netem::impaired(words);
  std::vector<double> draws;
  std::vector<double> decisions;
  std::vector<double> ratios;
  for (int i = 0; i < rounds; ++i) {
    draws.push_back(draw_seconds());
    decisions.push_back(decision_seconds(config));
    ratios.push_back(decisions.back() / draws.back());
  }
  std::printf("draws %.2f ms, decisions %.2f ms, ratio %.1f: %s\n",
              1e3 * median(draws),
              1e3 * median(decisions),
              median(ratios),
              words);
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 15;
  for (const char* words : palp::bench::kCombinations) palp::bench::compare(words, rounds);
  return 0;
}
