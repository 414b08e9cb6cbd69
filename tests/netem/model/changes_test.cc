#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "netem/model/channel.h"
#include "netem/syntax/timeline.h"
#include "tests/support/realtime_guard.h"

/// Goal: whatever can be said while a path runs can be done to it. Method: random sequences of
/// lines of live control, those that are understood are applied to a channel under traffic.
namespace palp::netem {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::array kBeginnings{"none",
                                 "delay 5ms loss 5% 50%",
                                 "replay first.csv",
                                 "mode netem-6.1 delay 5ms",
                                 "mode netem-6.1 delay 2ms slot 3ms 5ms packets 2 limit 20"};

constexpr std::array kLines{
    R"({"set":"none"})",
    R"({"set":"delay 7ms 2ms 25% distribution normal"})",
    R"({"set":"delay 7ms 2ms distribution gamma correlation-time 40ms stall 5/s 10ms"})",
    R"({"set":"mode netem-6.1 delay 5ms"})",
    R"({"set":"mode netem-6.1 delay 3ms slot 2ms 4ms"})",
    R"({"set":"mode exact delay 5ms"})",
    R"({"set":"slot 2ms 4ms packets 2"})",
    R"({"set":"loss 30% 90% duplicate 20% corrupt 10% order netem"})",
    R"({"set":"loss state 10% 20% loss gilbert-time 10ms 5ms"})",
    R"({"set":"rate 1mbit queue packets 5 codel"})",
    R"({"set":"rate 1mbit limit 4"})",
    R"({"set":"order swap 20% depth 4 delay 5ms reorder 10% gap 2"})",
    R"({"set":"histogram bins.txt"})",
    R"({"set":"trace walk.csv loop"})",
    R"({"set":"replay first.csv"})",
    R"({"set":"replay second.csv"})",
    R"({"ramp":{"over_s":0.02,"set":"delay 20ms 3ms loss 50% 80%"}})",
    R"({"ramp":{"over_s":0.02,"set":"histogram bins.txt"}})",
    R"({"ramp":{"over_s":0.02,"set":"trace walk.csv"}})",
    R"({"ramp":{"over_s":0.02,"set":"mode netem-6.1 delay 20ms"}})",
    R"({"trace":{"file":"walk.csv","loop":true,"dither":true}})",
    R"({"stall":{"ms":10}})",
    R"({"blackout":{"ms":10}})",
    R"({"flood":{"copies":15,"ms":10}})",
    R"({"rebind":{}})"};

/// A recording of a thousand datagrams with one delay, each so many times.
std::string recorded(Duration delay, int copies) {
  std::string text = "index,sent_ns,arrived_ns,copy,verdict,flipped_bit\n";
  for (std::int64_t i = 0; i < 1000; ++i) {
    for (int copy = 0; copy < copies; ++copy) {
      text += std::to_string(i) + "," + std::to_string(i) + "," +
              std::to_string(i + delay.count()) + "," + std::to_string(copy) + ",delivered,\n";
    }
  }
  return text;
}

Result<std::string> files(const std::string& name) {
  if (name == "walk.csv") return std::string{"t_ms,delay_ms\n0,5\n100,7\n"};
  if (name == "bins.txt") return std::string{"10 1\n20 1\n"};
  if (name == "first.csv") return recorded(milliseconds{10}, 3);
  if (name == "second.csv") return recorded(milliseconds{30}, 1);
  return fail("no file '" + name + "'");
}

/// A channel and what is said to it.
class Path {
 public:
  Path(std::string_view words, std::uint64_t seed)
      : law_{*parse_impairment(words, Mode::Exact, files)},
        channel_{law_, seed, Direction::Up, 64} {}

  /// @returns whether the line was understood, and so applied.
  bool say(std::string_view line) {
    auto request = parse_control_line(line, {.up = law_, .down = law_}, files);
    if (!request) return false;
    const Change& change = request->change_up;
    const bool law = change.kind == Change::Kind::Set || change.kind == Change::Kind::Ramp;
    if (law) law_ = change.impairment;
    PreparedChange prepared = prepare(change);
    channel_.apply(prepared, now_);
    return true;
  }
  /// A datagram after `pause`, and whoever is due. @returns what was decided.
  std::vector<Decision> send(Duration pause) {
    now_ += pause;
    const std::array<std::byte, 100> datagram{};
    const auto decided = channel_.push(datagram, now_);
    std::vector<Decision> decisions{decided.begin(), decided.end()};
    while (channel_.pop_in_place(now_)) {
    }
    return decisions;
  }
  [[nodiscard]] bool conserves() const {
    const ChannelCounters& counters = channel_.counters();
    return counters.pushed + counters.copies == counters.popped + counters.lost +
                                                    counters.header_hit + counters.blackout +
                                                    counters.over_limit + channel_.in_flight();
  }

 private:
  Impairment law_;
  Channel channel_;
  TimePoint now_{};
};

RC_GTEST_PROP(ChangesTest, WhateverCanBeSaidCanBeDone, ()) {
  Path path{*rc::gen::elementOf(kBeginnings), *rc::gen::arbitrary<std::uint64_t>()};
  for (int i = *rc::gen::inRange(1, 12); i > 0; --i) {
    (void)path.say(*rc::gen::elementOf(kLines));
    for (int k = *rc::gen::inRange(0, 40); k > 0; --k) {
      const auto decisions = path.send(microseconds{*rc::gen::inRange(0, 3000)});
      for (const Decision& decision : decisions) {
        RC_ASSERT(decision.verdict != Verdict::Delivered ||
                  decision.released_at >= decision.arrived_at);
      }
      RC_ASSERT(path.conserves());
    }
  }
}

TEST(ChangesTest, AReplaySetAnewGivesEachDatagramItsOwnRow) {
  Path path{"replay first.csv", 1};
  const auto all_intended = [&](int count, Duration delay) {
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(path.send(milliseconds{1}).at(0).intended, delay) << i;
    }
  };
  all_intended(100, milliseconds{10});
  EXPECT_TRUE(path.say(R"({"set":"replay second.csv"})"));
  all_intended(100, milliseconds{30});
  EXPECT_TRUE(path.say(R"({"set":"delay 5ms"})"));
  all_intended(100, milliseconds{5});
  EXPECT_TRUE(path.say(R"({"set":"replay first.csv"})"));
  all_intended(100, milliseconds{10});
}

TEST(ChangesTest, ALoopingPlanAllocatesNothingOnceItRuns) {
  constexpr const char* kPlan = R"(
    loop: true length_s: 0.5
    event { set: "delay 5ms 2ms 25% distribution gamma loss 5% 50%" }
    event { at_s: 0.1 ramp { over_s: 0.05 set: "histogram bins.txt" } }
    event { at_s: 0.2 set: "rate 1mbit queue packets 100 codel delay 5ms" }
    event { at_s: 0.3 set: "slot 1ms 3ms packets 5 order swap 10% depth 8 delay 5ms" }
    event { at_s: 0.35 trace { file: "walk.csv" loop: true } }
    event { at_s: 0.4 set: "replay second.csv" }
    event { at_s: 0.45 stall { ms: 20 } }
    event { at_s: 0.46 flood { copies: 15 ms: 20 } }
    event { at_s: 0.48 blackout { ms: 10 } })";
  const auto no_preset = [](const std::string&) -> Result<Timeline> { return fail("no preset"); };
  const auto timeline = parse_timeline("plan", kPlan, no_preset, files);
  ASSERT_TRUE(timeline) << timeline.error().text;
  Channel channel{timeline->up, 1, Direction::Up, 512, TimePoint{}, 1472};
  PreparedChange set = prepare({.impairment = *parse_impairment("rate 1mbit queue packets 9")});
  PreparedChange ramp = prepare({.kind = Change::Kind::Ramp,
                                 .impairment = *parse_impairment("delay 9ms 1ms"),
                                 .span = milliseconds{40}});
  const std::array<std::byte, 100> datagram{};
  test::RealtimeGuard guard;
  for (int i = 0; i < 10'000; ++i) {
    // Three rounds seen and then some that nobody sees, again and again.
    const TimePoint now{milliseconds{i + i / 1500 * 10'000}};
    if (i == 2222) channel.apply(set, now);
    if (i == 3333) channel.apply(ramp, now);
    (void)channel.push(datagram, now);
    while (channel.pop_in_place(now)) {
    }
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
  EXPECT_EQ(channel.impaired_path().changes_applied(), 9U * (10'000 + 6 * 10'000) / 500 + 2);
}

TEST(ChangesTest, TellsTheLawThatWhoComesWillFind) {
  const auto set = [](Duration at, const char* words) {
    return Change{.at = at, .impairment = *parse_impairment(words)};
  };
  for (const Duration loop :
       {Duration{}, Duration{milliseconds{100}}, Duration{milliseconds{80}}}) {
    const PathPlan plan{.changes = {set(milliseconds{10}, "delay 1ms"),
                                    set(milliseconds{30}, "delay 2ms"),
                                    {.at = milliseconds{50}, .kind = Change::Kind::Rebind},
                                    set(milliseconds{80}, "delay 3ms")},
                        .loop = loop};
    for (int first = 0; first < 150; first += 13) {
      for (int then = first; then < 500; then += 17) {
        ImpairedPath impaired_path{plan, 1, Direction::Up, 9, 9, TimePoint{}};
        (void)impaired_path.push({.at = TimePoint{milliseconds{first}}, .length = 9, .room = 9});
        const TimePoint at{milliseconds{then}};
        const std::uint64_t number = impaired_path.law_number(at);
        (void)impaired_path.push({.at = at, .length = 9, .room = 9});
        ASSERT_EQ(number, impaired_path.law_number(at)) << first << ' ' << then;
        ASSERT_EQ(impaired_path.impairment(),
                  number == 0 ? plan.impairment : plan.changes.at(number - 1).impairment)
            << first << ' ' << then;
      }
    }
  }
}

TEST(ChangesTest, WhatIsSaidComesBehindWhatThePlanHadBefore) {
  PathPlan plan;
  plan.changes.push_back({.at = milliseconds{10}, .impairment = *parse_impairment("delay 5ms")});
  Channel channel{plan, 1, Direction::Up, 99, TimePoint{}, 1472};
  PreparedChange change = prepare({.impairment = *parse_impairment("delay 7ms")});
  // Nobody came since the plan's change was due.
  channel.apply(change, TimePoint{milliseconds{20}});
  const std::array<std::byte, 10> datagram{};
  EXPECT_EQ(channel.push(datagram, TimePoint{milliseconds{30}})[0].intended, milliseconds{7});
}

}  // namespace
}  // namespace palp::netem
