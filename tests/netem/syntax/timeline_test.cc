#include "netem/syntax/timeline.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "netem/model/channel.h"
#include "netem/model/simulation.h"
#include "netem/syntax/presets.h"

namespace palp::netem {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr const char* kDay = R"(
mode: EXACT   seed: 7   loop: false
event { at_s: 0    dir: BOTH set: "delay 16ms 3ms distribution gamma correlation-time 40ms" }
event { at_s: 12.5 dir: UP   stall { ms: 265 } }
event { at_s: 20   dir: BOTH blackout { ms: 600 } }
event { at_s: 30   dir: DOWN ramp { over_s: 5 set: "delay 80ms 8ms" } }
event { at_s: 40   dir: UP   rebind {} }
event { at_s: 50   dir: DOWN trace { file: "walk.csv" loop: true } }
event { at_s: 60   dir: BOTH flood { copies: 2 ms: 10 } }
)";

Result<std::string> files(const std::string& name) {
  if (name == "walk.csv") return std::string{"t_ms,delay_ms\n0,5\n100,7\n"};
  return fail("no file '" + name + "'");
}

Result<Timeline> parsed(std::string_view text) {
  return parse_timeline(
      "day", text, [](const std::string& name) { return find_preset(name); }, files);
}

TEST(TimelineTest, ReadsEveryKindOfEvent) {
  const auto timeline = parsed(kDay);
  ASSERT_TRUE(timeline) << timeline.error().text;
  EXPECT_EQ(timeline->seed, 7U);
  EXPECT_EQ(timeline->up.impairment.delay.mean, milliseconds{16});
  std::vector<Change::Kind> up;
  for (const Change& change : timeline->up.changes) up.push_back(change.kind);
  using Kind = Change::Kind;
  EXPECT_EQ(up, (std::vector{Kind::Stall, Kind::Blackout, Kind::Rebind, Kind::Flood}));
  ASSERT_EQ(timeline->down.changes.size(), 4U);
  EXPECT_EQ(timeline->down.changes[0].at, seconds{20});
  EXPECT_EQ(timeline->down.changes[1].span, seconds{5});
  EXPECT_EQ(timeline->down.changes[2].impairment.trace.points.size(), 2U);
  EXPECT_EQ(timeline->down.changes[3].copies, 2U);
}

TEST(TimelineTest, StandsOnAPreset) {
  const auto timeline = parsed("preset: \"transatlantic\" event { at_s: 1 blackout { ms: 5 } }");
  ASSERT_TRUE(timeline) << timeline.error().text;
  EXPECT_EQ(timeline->up.impairment.delay.mean, std::chrono::microseconds{37'500});
  EXPECT_EQ(timeline->up.changes.size(), 1U);
}

TEST(TimelineTest, RefusesWithLineAndColumn) {
  for (const auto& [text, begin] : std::vector<std::pair<const char*, const char*>>{
           {"event { at_s: 1 }", "day:1:1: an event needs one of"},
           {"mode: EXACT\nevent { sett: \"\" }", "day:2:13: "},
           {"event {\n  set: \"delay 5minutes\"\n}", "day:2:3: impairment, column 7"},
           {"event { at_s: 2 rebind {} }\nevent { at_s: 1 rebind {} }",
            "day:2:9: events must be in"},
           {"event { at_s: -1 rebind {} }", "day:1:9: at_s"},
           {"event { stall { ms: 0 } }", "day:1:9: ms must be above 0"},
           {"event { trace { file: \"run.csv\" } }", "day:1:9: impairment, column 7: no file"},
           {"preset: \"moon\"", "day:1:1: preset 'moon' is unknown"},
           {"loop: true", "day:1:1: a loop lasts"},
           {"mode: FAST", "day:1:11: "},
           {"event { ramp { over_s: 0 set: \"none\" } }", "day:1:9: over_s"},
           {"event { flood { copies: 99 ms: 1 } }", "day:1:9: copies"},
           {"mode: NETEM_6_1 event { set: \"order keep\" }", "day:1:25: impairment, column 1"}}) {
    const auto timeline = parsed(text);
    ASSERT_FALSE(timeline) << text;
    EXPECT_EQ(timeline.error().text.rfind(begin, 0), 0U) << timeline.error().text;
  }
}

/// The decisions about one datagram each millisecond.
std::vector<Decision> decisions(const PathPlan& plan, std::uint64_t packets) {
  std::vector<Decision> all;
  (void)simulate({.plan = plan, .packets = packets, .interval = milliseconds{1}},
                 [&](const Decision& decision) { all.push_back(decision); });
  return all;
}

TEST(TimelineTest, AppliesEachChangeWithTheFirstDatagramAtItsTime) {
  const auto timeline = parsed(
      "event { set: \"delay 10ms\" } event { at_s: 0.1 set: \"delay 20ms\" }"
      "event { at_s: 0.2 blackout { ms: 50 } } event { at_s: 0.3 stall { ms: 40 } }"
      "event { at_s: 0.4 flood { copies: 3 ms: 5 } }"
      "event { at_s: 0.5 ramp { over_s: 0.1 set: \"delay 40ms\" } }");
  ASSERT_TRUE(timeline);
  std::vector<Decision> originals;
  std::size_t copies = 0;
  for (const Decision& decision : decisions(timeline->up, 800)) {
    if (decision.copy == 0) originals.push_back(decision);
    copies += decision.copy > 0 ? 1 : 0;
  }
  const auto delay = [&](std::size_t i) {
    return originals[i].released_at - originals[i].arrived_at;
  };
  EXPECT_EQ(delay(99), milliseconds{10});
  EXPECT_EQ(delay(100), milliseconds{20});
  EXPECT_EQ(originals[199].verdict, Verdict::Delivered);
  EXPECT_EQ(originals[200].verdict, Verdict::Blackout);
  EXPECT_EQ(originals[249].verdict, Verdict::Blackout);
  EXPECT_EQ(originals[250].verdict, Verdict::Delivered);
  // Held to the end of the stall, then all at once.
  EXPECT_EQ(delay(300), milliseconds{60});
  EXPECT_EQ(delay(339), milliseconds{21});
  EXPECT_EQ(originals[300].released_at, originals[339].released_at);
  EXPECT_EQ(copies, 15U);
  EXPECT_EQ(delay(550), milliseconds{30});
  EXPECT_EQ(delay(700), milliseconds{40});
}

TEST(TimelineTest, ALoopBeginsAgain) {
  const auto timeline = parsed(
      "loop: true length_s: 0.2 event { set: \"delay 10ms\" } event { at_s: 0.1 set: \"delay "
      "20ms\" }");
  ASSERT_TRUE(timeline);
  const auto all = decisions(timeline->up, 1000);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].intended, milliseconds{i % 200 < 100 ? 10 : 20}) << i;
  }
}

TEST(TimelineTest, ARampGoesBetweenTheMeansOfHistograms) {
  // Even between 10 and 20 ms, then 20 and 30: means of 15 and 25 ms.
  const auto file = [](const std::string& name) -> Result<std::string> {
    return std::string{name == "low" ? "10 1\n20 0\n" : "20 1\n30 0\n"};
  };
  const auto mean = [&](const char* from, const char* to) {
    PathPlan plan{.impairment = *parse_impairment(from, Mode::Exact, file)};
    plan.changes.push_back({.at = {},
                            .kind = Change::Kind::Ramp,
                            .impairment = *parse_impairment(to, Mode::Exact, file),
                            .span = seconds{2'000'000}});
    // In the middle of the ramp, where 200 s change little.
    ImpairedPath impaired_path{plan, 3, Direction::Up, 10'000, 10'000, TimePoint{}};
    double sum = 0;
    for (int i = 0; i < 4000; ++i) {
      const TimePoint at = TimePoint{seconds{999'900}} + milliseconds{50 * i};
      sum += palp::seconds(impaired_path.push({.at = at, .length = 100, .room = 99})[0].intended);
      while (impaired_path.pop(at)) {
      }
    }
    return sum / 4000;
  };
  // Standard deviations of at most 2.9 ms: four standard errors are 0.19 ms.
  EXPECT_NEAR(mean("histogram low", "histogram high"), 0.020, 0.0002);
  EXPECT_NEAR(mean("histogram low", "delay 45ms"), 0.030, 0.0002);
  EXPECT_NEAR(mean("delay 5ms", "histogram high"), 0.015, 0.0002);
}

TEST(TimelineTest, RoundsThatNobodySawAreNotWalkedThrough) {
  const auto timeline = parsed(
      "loop: true length_s: 0.001 event { set: \"delay 10ms\" }"
      "event { at_s: 0.0004 set: \"delay 20ms\" } event { at_s: 0.0008 rebind {} }");
  ASSERT_TRUE(timeline);
  ImpairedPath impaired_path{timeline->up, 1, Direction::Up, 99, 99, TimePoint{}};
  const auto delay = [&](Duration at) {
    const Decision decision = impaired_path.push({.at = TimePoint{at}, .length = 9, .room = 99})[0];
    while (impaired_path.pop(decision.released_at)) {
    }
    return decision.intended;
  };
  using std::chrono::microseconds;
  EXPECT_EQ(delay(microseconds{100}), milliseconds{10});
  EXPECT_EQ(impaired_path.changes_applied(), 1U);
  // A year of milliseconds: walked through, this test would not end.
  const Duration year = seconds{31'536'000};
  EXPECT_EQ(delay(year + microseconds{500}), milliseconds{20});
  EXPECT_EQ(impaired_path.changes_applied(), 3 * 31'536'000'000U + 2) << "as if each had been seen";
  EXPECT_EQ(impaired_path.rebinds(), 1U);
  EXPECT_EQ(delay(year + microseconds{1000}), milliseconds{10});
}

TEST(TimelineTest, AChangeDoesNotReshuffleTheFuture) {
  const auto before = parsed("event { set: \"delay 50ms 5ms loss 10% order netem\" }");
  const auto changed = parsed(
      "event { set: \"delay 50ms 5ms loss 10% order netem\" }"
      "event { at_s: 0.1 set: \"delay 90ms 5ms loss 10% order netem\" }");
  ASSERT_TRUE(before && changed);
  const auto one = decisions(before->up, 500);
  const auto other = decisions(changed->up, 500);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].verdict, other[i].verdict);
    if (one[i].verdict != Verdict::Delivered) continue;
    EXPECT_EQ(other[i].intended - one[i].intended, milliseconds{i < 100 ? 0 : 40});
  }
}

TEST(TimelineTest, AChangeKeepsTheModeOfItsDirection) {
  const auto later = parsed("event { at_s: 1 set: \"mode netem-6.1 delay 5ms\" }");
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error().text,
            "day:1:17: a change keeps the mode, which is exact here, not netem-6.1");
  EXPECT_FALSE(parsed("event { at_s: 1 ramp { over_s: 1 set: \"mode netem-6.1\" } }"));
  EXPECT_FALSE(parsed("mode: NETEM_6_1 event { at_s: 1 set: \"mode exact\" }"));
  EXPECT_FALSE(parsed("event { stall { ms: 1 } } event { set: \"mode netem-6.1\" }"));
}

TEST(TimelineTest, TheKernelKnowsNeitherRampsNorFloods) {
  const auto ramp = parsed("mode: NETEM_6_1 event { ramp { over_s: 5 set: \"delay 5ms\" } }");
  ASSERT_FALSE(ramp);
  EXPECT_EQ(ramp.error().text, "day:1:25: mode netem-6.1 knows no ramp");
  const auto flood = parsed("mode: NETEM_6_1 event { flood { copies: 1 ms: 5 } }");
  ASSERT_FALSE(flood);
  EXPECT_EQ(flood.error().text, "day:1:25: mode netem-6.1 knows no flood");
}

TEST(TimelineTest, ARampNeedsAMeanAtBothEnds) {
  constexpr const char* kRamp = "event { at_s: 2 ramp { over_s: 1 set: \"delay 5ms\" } }";
  for (const std::string begins : {"trace { file: \"walk.csv\" }", "set: \"trace walk.csv\""}) {
    const auto from = parsed("event { at_s: 1 " + begins + " }" + kRamp);
    ASSERT_FALSE(from);
    EXPECT_NE(from.error().text.find("has no mean delay"), std::string::npos);
  }
  EXPECT_FALSE(parsed("event { at_s: 1 ramp { over_s: 1 set: \"trace walk.csv\" } }"));
  EXPECT_TRUE(parsed(std::string{kRamp} + "event { at_s: 4 trace { file: \"walk.csv\" } }"));
  const auto round =
      parsed("loop: true " + std::string{kRamp} + "event { at_s: 4 trace { file: \"walk.csv\" } }");
  ASSERT_FALSE(round) << "the second round would begin at the trace";
  EXPECT_EQ(round.error().text.rfind("day:1:1: the first ramp", 0), 0U);
}

TEST(TimelineTest, WhatIsSetAtTheStartChoosesTheModeOfItsDirection) {
  const auto timeline = parsed(
      "event { dir: UP set: \"mode netem-6.1 delay 5ms\" }"
      "event { at_s: 1 dir: UP set: \"delay 7ms\" } event { at_s: 1 dir: DOWN set: \"floor 1%\" }");
  ASSERT_TRUE(timeline) << timeline.error().text;
  EXPECT_EQ(timeline->up.impairment.mode, Mode::Netem61);
  EXPECT_EQ(timeline->up.changes.at(0).impairment.mode, Mode::Netem61);
  EXPECT_EQ(timeline->down.impairment.mode, Mode::Exact);
}

TEST(ControlLineTest, EachDirectionUnderstandsItsOwnMode) {
  const ControlContext context{.up = *parse_impairment("mode netem-6.1 delay 5ms"), .down = {}};
  const auto down = parse_control_line(R"({"dir":"DOWN","set":"delay 5ms floor 10%"})", context);
  ASSERT_TRUE(down) << down.error().text;
  EXPECT_EQ(down->change_down.impairment.mode, Mode::Exact);
  const auto up = parse_control_line(R"({"dir":"UP","set":"delay 7ms"})", context);
  ASSERT_TRUE(up) << up.error().text;
  EXPECT_EQ(up->change_up.impairment.mode, Mode::Netem61);
  EXPECT_FALSE(parse_control_line(R"({"dir":"UP","set":"delay 5ms floor 10%"})", context));
  EXPECT_FALSE(parse_control_line(R"({"dir":"DOWN","set":"mode netem-6.1"})", context));
}

TEST(ControlLineTest, ReadsAnEventAsJsonAndItsOwnQuestions) {
  const ControlContext context;
  const auto set = parse_control_line(R"({"dir":"UP","set":"delay 5ms"})", context, files);
  ASSERT_TRUE(set) << set.error().text;
  EXPECT_TRUE(set->up);
  EXPECT_FALSE(set->down);
  EXPECT_TRUE(set->now);
  EXPECT_EQ(set->change_up.impairment.delay.mean, milliseconds{5});
  const auto later = parse_control_line(R"({"at_s": 12.5, "stall": {"ms": 265}})", context, files);
  ASSERT_TRUE(later) << later.error().text;
  EXPECT_FALSE(later->now);
  EXPECT_EQ(later->change_down.span, milliseconds{265});
  EXPECT_EQ(parse_control_line(R"({"stats":true})", context, files)->kind,
            ControlRequest::Kind::Stats);
  EXPECT_EQ(parse_control_line(R"({"quit":true})", context, files)->kind,
            ControlRequest::Kind::Quit);
  EXPECT_EQ(parse_control_line(R"({"record":"run"})", context, files)->prefix, "run");
  for (const char* wrong : {"",
                            "stats",
                            "{",
                            R"({"sett":"none"})",
                            R"({"set":"delay 5minutes"})",
                            R"({"at_s":-1,"rebind":{}})",
                            R"({"quit":false})",
                            R"({"stats":false})",
                            "{}"}) {
    EXPECT_FALSE(parse_control_line(wrong, context, files)) << wrong;
  }
}

}  // namespace
}  // namespace palp::netem
