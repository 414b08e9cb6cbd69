#include "netem/model/plan_cursor.h"

#include <vector>

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

using std::chrono::milliseconds;

constexpr TimePoint kStart{std::chrono::seconds{3}};

/// A law, a blackout and another law, 10 ms apart.
PathPlan plan(Duration loop) {
  PathPlan plan;
  plan.changes.push_back({.at = milliseconds{10}, .kind = Change::Kind::Set});
  plan.changes.push_back({.at = milliseconds{20}, .kind = Change::Kind::Blackout});
  plan.changes.push_back({.at = milliseconds{30}, .kind = Change::Kind::Ramp});
  plan.loop = loop;
  return plan;
}

/// Who looks at the plan in steps: what it saw.
struct Looker {
  explicit Looker(Duration loop) : cursor{plan(loop), kStart} {}
  void look(Duration since) {
    cursor.pass(kStart + since, [&](const PreparedChange& change, TimePoint at) {
      EXPECT_TRUE(times.empty() || times.back() < at);
      times.push_back(at);
      if (change.law) law = change.law_number;
    });
  }
  PlanCursor cursor;
  std::vector<TimePoint> times;
  std::uint64_t law{};
};

TEST(PlanCursorTest, EachChangeComesOnceAtItsTime) {
  Looker looker{Duration{}};
  looker.look(milliseconds{10} - Duration{1});
  EXPECT_TRUE(looker.times.empty());
  looker.look(milliseconds{10});
  EXPECT_EQ(looker.times.size(), 1U);
  looker.look(std::chrono::hours{1});
  EXPECT_EQ(looker.times,
            (std::vector<TimePoint>{
                kStart + milliseconds{10}, kStart + milliseconds{20}, kStart + milliseconds{30}}));
  EXPECT_EQ(looker.cursor.skipped(), 0U);
}

/// Goal: how often anybody looks changes nothing. Method: one looks each millisecond, one every so
/// often; at the same time the same law holds, as foreseen, and as many changes have passed.
TEST(PlanCursorTest, WhoLooksSeldomMissesNothing) {
  for (const int pause : {7, 33, 50, 90, 1234}) {
    Looker often{milliseconds{40}};
    Looker seldom{milliseconds{40}};
    for (int ms = 0; ms < 5'000; ++ms) {
      const Duration since = milliseconds{ms};
      often.look(since);
      ASSERT_EQ(seldom.cursor.law_number(kStart + since, seldom.law), often.law) << pause << ms;
      if (ms % pause != 0) continue;
      seldom.look(since);
      ASSERT_EQ(seldom.law, often.law) << pause << " " << ms;
      ASSERT_EQ(seldom.times.size() + seldom.cursor.skipped(), often.times.size());
    }
    EXPECT_EQ(often.cursor.skipped(), 0U);
    EXPECT_EQ(seldom.cursor.skipped() > 0, pause > 80) << pause;
  }
}

TEST(PlanCursorTest, ALawFromOutsideHoldsUntilARoundBringsOneOfItsOwn) {
  constexpr std::uint64_t kOutside = 1000;
  PathPlan rounds;
  rounds.changes.push_back({.at = milliseconds{10}, .kind = Change::Kind::Set});
  rounds.changes.push_back({.at = milliseconds{20}, .kind = Change::Kind::Blackout});
  rounds.loop = milliseconds{40};
  PlanCursor cursor{rounds, kStart};
  cursor.pass(kStart + milliseconds{15}, [](const PreparedChange&, TimePoint) {});
  const auto foreseen = [&](int ms) {
    return cursor.law_number(kStart + milliseconds{ms}, kOutside);
  };
  EXPECT_EQ(foreseen(45), kOutside);
  EXPECT_EQ(foreseen(50), 1U);
  EXPECT_EQ(foreseen(85), 1U) << "a round later, before its own law";
}

TEST(PlanCursorTest, OnlyLawsArePreparedAndNumbered) {
  EXPECT_EQ(prepare({.kind = Change::Kind::Stall}).law, nullptr);
  EXPECT_NE(prepare({.kind = Change::Kind::Set}).law, nullptr);
  Looker looker{Duration{}};
  looker.look(milliseconds{20});
  EXPECT_EQ(looker.law, 1U);
  looker.look(milliseconds{30});
  EXPECT_EQ(looker.law, 3U);
}

}  // namespace
}  // namespace palp::netem
