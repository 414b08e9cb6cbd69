#include <array>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include "common/link/transport.h"
#include "netem/model/channel.h"
#include "tests/netem/model/impairment_builders.h"

/// Cost of one datagram of 200 bytes through a channel: push and pop, one each millisecond of
/// virtual time. Reference: the two copies of its bytes alone.
namespace palp::netem {
namespace {

constexpr std::size_t kSize = 200;

void channel(benchmark::State& state, const char* words) {
  Channel channel{impaired(words), 1, Direction::Up, 4096};
  const std::vector<std::byte> datagram(kSize);
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  TimePoint now{};
  for (auto _ : state) {
    channel.push(datagram, now);
    while (const auto released = channel.pop(buffer, now)) benchmark::DoNotOptimize(buffer);
    now += std::chrono::milliseconds{1};
  }
}

void copies(benchmark::State& state) {
  std::array<std::byte, kSize> from{};
  std::array<std::byte, kSize> between{};
  std::array<std::byte, kSize> to{};
  for (auto _ : state) {
    benchmark::DoNotOptimize(from);
    between = from;
    benchmark::DoNotOptimize(between);
    to = between;
    benchmark::DoNotOptimize(to);
  }
}

BENCHMARK(copies);
BENCHMARK_CAPTURE(channel, none, "none");
BENCHMARK_CAPTURE(channel, constant, "delay 50ms");
BENCHMARK_CAPTURE(channel, loss, "delay 50ms loss 5%");
BENCHMARK_CAPTURE(channel, plain_law, "delay 50ms 15ms distribution normal floor 20% order free");
BENCHMARK_CAPTURE(channel,
                  long_plain_law,
                  "delay 1s 300ms distribution normal floor 20% order free");
BENCHMARK_CAPTURE(channel,
                  harsh,
                  "delay 250ms 75ms distribution normal floor 20% loss 5% loss burst 0.2/s 200ms "
                  "duplicate 5% order free");
BENCHMARK_CAPTURE(
    channel,
    correlated,
    "delay 50ms 5ms distribution normal correlation-time 40ms loss gilbert-time 1s 20ms");
BENCHMARK_CAPTURE(channel, correlated_uniform, "delay 50ms 5ms 50%");

}  // namespace
}  // namespace palp::netem
