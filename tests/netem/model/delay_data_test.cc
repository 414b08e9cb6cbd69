#include "netem/model/delay_data.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "netem/model/simulation.h"
#include "netem/syntax/data_files.h"
#include "tests/netem/model/impairment_builders.h"

namespace palp::netem {
namespace {

const std::vector<std::string>& traces() {
  static const std::vector<std::string> names{"5g_n78_arterial_v80_handover.csv",
                                              "5g_n78_urban_v30_10ms.csv",
                                              "5g_n8_rural_static_stalls.csv",
                                              "5g_n8_urban_static_calm.csv",
                                              "5g_n8_urban_v30_10ms.csv",
                                              "5g_n8_w2s_v30_spikes.csv"};
  return names;
}

std::string shipped(const std::string& name) { return std::string{PALP_NETEM_TRACES} + "/" + name; }

class DelayTraceTest : public ::testing::TestWithParam<std::string> {};

TEST_P(DelayTraceTest, IsReplayedExactlyAtItsOwnTimes) {
  const std::string name = shipped(GetParam());
  const DelayTrace trace = *parse_delay_trace(name, *read_data_file(name));
  ImpairedPath impaired_path{
      {.impairment = impaired("trace " + name)}, 1, Direction::Up, 10'000, 10'000, TimePoint{}};
  for (const DelayTrace::Point& point : trace.points) {
    const auto decisions =
        impaired_path.push({.at = TimePoint{point.sent}, .length = 100, .room = 10'000});
    ASSERT_EQ(decisions.front().released_at, TimePoint{point.sent + point.delay});
  }
}

TEST_P(DelayTraceTest, KeepsOrderAndTheShapeOfItsStallsAtAnotherRate) {
  const std::string name = shipped(GetParam());
  const DelayTrace trace = *parse_delay_trace(name, *read_data_file(name));
  Duration longest{};
  for (const DelayTrace::Point& point : trace.points) longest = std::max(longest, point.delay);
  const auto result = simulate({.plan = {.impairment = impaired("trace " + name)},
                                .packets = static_cast<std::uint64_t>(trace.points.back().sent /
                                                                      std::chrono::milliseconds{1}),
                                .interval = std::chrono::milliseconds{1}},
                               [](const Decision&) {});
  EXPECT_EQ(result.reordered, 0U);
  // A message held by a stall is met on its millisecond.
  EXPECT_EQ(result.delay.max(), longest);
}

TEST_P(DelayTraceTest, NeverOvertakesAtTheSeamOfItsLoop) {
  const std::string name = shipped(GetParam());
  const auto result = simulate({.plan = {.impairment = impaired("trace " + name + " loop dither")},
                                .packets = 100'000,
                                .interval = std::chrono::milliseconds{7}});
  EXPECT_EQ(result.reordered, 0U);
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         DelayTraceTest,
                         ::testing::ValuesIn(traces()),
                         [](const auto& test) {
                           std::string name = test.param.substr(0, test.param.find('.'));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(DelayDataTest, ADecimalCommaIsAThirdColumnAndAMarkIsNone) {
  const auto comma = parse_delay_histogram("h", "0,5,3\n1,5,4\n");
  ASSERT_FALSE(comma);
  EXPECT_NE(comma.error().text.find("two columns"), std::string::npos);
  EXPECT_TRUE(parse_delay_histogram("h",
                                    "\xef\xbb\xbf"
                                    "0.5,3\n1.5,4\n"));
  EXPECT_TRUE(parse_delay_trace("t", "\xef\xbb\xbft_ms,delay_ms\n0,5\n100,7\n"));
}

class DelayHistogramTest : public ::testing::TestWithParam<std::string> {};

/// Goal: each bin gets its share. Method: 200,000 independent draws, within four standard errors.
TEST_P(DelayHistogramTest, IsSampledBinByBin) {
  const std::string name = shipped(GetParam());
  const DelayHistogram histogram = *parse_delay_histogram(name, *read_data_file(name));
  constexpr std::uint64_t kCount = 200'000;
  std::vector<double> seen(histogram.bins.size());
  (void)simulate(
      {.plan = {.impairment = impaired("histogram " + name + " order netem")},
       .packets = kCount,
       .interval = std::chrono::milliseconds{1}},
      [&](const Decision& decision) {
        const double ms = seconds(decision.intended) * 1e3;
        const auto above = std::upper_bound(
            histogram.bins.begin(), histogram.bins.end(), ms, [](double value, const auto& bin) {
              return value < bin.lower_ms;
            });
        ASSERT_NE(above, histogram.bins.begin());
        seen[static_cast<std::size_t>(above - histogram.bins.begin()) - 1] += 1;
      });
  double total = 0;
  for (const auto& bin : histogram.bins) total += bin.count;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double expected = histogram.bins[i].count / total;
    // An edge that is no whole nanosecond may move one draw to the neighbour.
    const double error = std::sqrt(std::max(expected, 1.0 / kCount) / kCount);
    EXPECT_NEAR(seen[i] / kCount, expected, 4 * error) << "bin " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         DelayHistogramTest,
                         ::testing::Values("5G-midband-Uplink_PD-Wireless-5G-2a.csv",
                                           "5G-midband-Downlink_PD-Wireless-5G-2a.csv"),
                         [](const auto& test) {
                           return test.param.find("Uplink") == std::string::npos ? "Downlink"
                                                                                 : "Uplink";
                         });

TEST(DelayTraceTest, BetweenTwoMessagesArrivalsGoEvenly) {
  Impairment impairment;
  impairment.trace = *parse_delay_trace("t", "t_ms,delay_ms\n0,5\n100,305\n200,205\n");
  std::vector<Duration> delays;
  (void)simulate(
      {.plan = {.impairment = impairment}, .packets = 9, .interval = std::chrono::milliseconds{25}},
      [&](const Decision& decision) {
        delays.push_back(decision.released_at - decision.arrived_at);
      });
  EXPECT_EQ(delays[2], std::chrono::milliseconds{155});
  // The hold ends for all at once: everybody of the second stretch arrives at 405 ms.
  EXPECT_EQ(delays[5], std::chrono::milliseconds{280});
  EXPECT_EQ(delays[6], std::chrono::milliseconds{255});
  EXPECT_EQ(delays[8], std::chrono::milliseconds{205});
}

TEST(RecordingTest, ReplayingARecordingAndRecordingItAgainIsTheIdentity) {
  const auto record = [](const Impairment& impairment) {
    std::string text = std::string{kRecordingHeader} + "\n";
    (void)simulate({.plan = {.impairment = impairment},
                    .packets = 5000,
                    .interval = std::chrono::milliseconds{1}},
                   [&](const Decision& decision) {
                     append_recording_line(text, decision, TimePoint{});
                     text += '\n';
                   });
    return text;
  };
  for (const char* words :
       {"delay 50ms 10ms distribution normal loss 5% duplicate 5% corrupt 3% order netem",
        "mode netem-6.1 delay 5ms slot 5ms 10ms loss 2%",
        "loss gemodel 1% 20% stall 1/s 100ms"}) {
    const std::string first = record(impaired(words));
    Impairment replay;
    replay.replay = *parse_recording("run", first);
    replay.order = Order::Netem;
    EXPECT_EQ(record(replay), first) << words;
  }
}

TEST(DelayDataTest, RefusesWithLineAndColumn) {
  const auto says = [](const auto& result, const std::string& begin) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().text.rfind(begin, 0), 0U) << result.error().text;
  };
  says(parse_delay_trace("t", "t,d\n"), "t:1:");
  says(parse_delay_trace("t", "t_ms,delay_ms\n0,5\n10,x\n"), "t:3:4: expected delay_ms");
  says(parse_delay_trace("t", "t_ms,delay_ms\n0,5\n0,6\n"), "t:3:1: expected a later t_ms");
  says(parse_delay_trace("t", "t_ms,delay_ms\n0,50\n10,5\n"), "t:3:4: expected an arrival");
  says(parse_delay_trace("t", "t_ms,delay_ms\n0,-5\n"), "t:2:3: expected delay_ms from 0");
  says(parse_delay_trace("t", "t_ms,delay_ms\n0,5\n"), "t: it is empty");
  says(parse_delay_histogram("h", "1 2\n1 3\n"), "h:2:1: expected rising");
  says(parse_delay_histogram("h", "1 -2\n"), "h:1:3: expected a count");
  says(parse_delay_histogram("h", "1 0\n2 0\n"), "h: it is empty");
  says(parse_delay_table("d", "# table\n1 2 40000\n"), "d:2:5: expected whole numbers");
  says(parse_loss_bitmap("b", "0102\n"), "b:1:1: expected 0 or 1");
  const std::string header = "index,sent_ns,arrived_ns,copy,verdict,flipped_bit\n";
  says(parse_recording("r", header + "0,0,5,0,delivered,\n0,0,5,0,delivered,\n"), "r:3:");
  says(parse_recording("r", header + "0,9,5,0,delivered,\n"), "r:2:5: expected arrived_ns");
  says(parse_recording("r", header + "0,0,,0,delivered,\n"), "r:2:");
  says(parse_recording("r", header + "0,0,,0,gone,\n"), "r:2:8: expected delivered");
}

TEST(DelayDataTest, TablesAreThoseThatTcShips) {
  for (const auto& [name, table, most] : {std::tuple{"normal.dist", normal_table(), 1},
                                          {"pareto.dist", pareto_table(), 0},
                                          {"paretonormal.dist", paretonormal_table(), 17}}) {
    const auto text = read_data_file(name);
    if (!text) GTEST_SKIP() << "the tables of the Debian package iproute2 are not installed";
    DelayTable shipped_table = *parse_delay_table(name, *text);
    std::sort(shipped_table.entries.begin(), shipped_table.entries.end());
    ASSERT_EQ(shipped_table.entries.size(), table.entries.size());
    for (std::size_t i = 0; i < table.entries.size(); ++i) {
      EXPECT_NEAR(shipped_table.entries[i], table.entries[i], most) << name << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace palp::netem
