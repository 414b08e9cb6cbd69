// Goal: a plan's results depend on the plan alone. Method: small sets, run whole and in shards,
// forwards and backwards.

#include "lab/batch.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "lab/adversary.h"
#include "lab/batch_report.h"
#include "lab/metric_table.h"
#include "lab/plan.h"
#include "lab/stability_map.h"
#include "lab/valve.h"
#include "lab/verbs.h"

namespace palp::lab {
namespace {

void forwards(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
}
void backwards(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = count; i-- > 0;) work(i);
}

Plan small_plan(std::uint64_t count) { return *make_set("mc", {.count = count, .seed = 5}); }

TEST(BatchTest, ResultsDoNotDependOnTheOrderOfTheWork) {
  const auto one = run_plan(small_plan(2), forwards, {}).value();
  const auto other = run_plan(small_plan(2), backwards, {}).value();
  EXPECT_EQ(digest_of(one), digest_of(other));
}

TEST(BatchTest, MergedShardsAreTheWholeSet) {
  const auto whole = run_plan(small_plan(3), forwards, {}).value();
  std::vector<CaseResult> merged;
  Plan read;
  for (const std::string part : {"1/2", "0/2"}) {
    Plan plan = small_plan(3);
    keep_shard(plan, *parse_shard(part));
    const auto rows = run_plan(plan, forwards, {}).value();
    const auto again = read_cases_csv(cases_csv(plan, rows), "cases", read).value();
    merged.insert(merged.end(), again.begin(), again.end());
  }
  std::sort(
      merged.begin(), merged.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
  EXPECT_EQ(digest_of(merged), digest_of(whole));
  for (std::size_t metric = 0; metric < metric_table().size(); ++metric) {
    const double kept = spread_of(merged, metric).p95;
    const double made = spread_of(whole, metric).p95;
    if (!std::isfinite(made)) continue;
    EXPECT_NEAR(kept, made, 1e-8 * std::abs(made));
  }
}

TEST(BatchReportTest, MergedRowsHaveNoMachine) {
  Plan plan = small_plan(1);
  const std::vector<CaseResult> none;
  const std::string merged = batch_summary(plan, none, {});
  EXPECT_EQ(merged.find("cores"), std::string::npos) << merged;
  BatchAccount account;
  account.cores = 2;
  account.cpu = account.wall = 1;
  EXPECT_NE(batch_summary(plan, none, account).find("on 2 cores"), std::string::npos);
  EXPECT_NE(batch_report(plan, none, {}).find("\"cores\": null"), std::string::npos);
}

TEST(PlanTest, TheFirstCasesOfALargerSetAreThoseOfASmallerOne) {
  const Plan small = small_plan(5);
  const Plan large = small_plan(50);
  for (std::size_t i = 0; i < small.cases.size(); ++i) {
    EXPECT_EQ(small.cases[i].labels, large.cases[i].labels);
    EXPECT_EQ(small.cases[i].seed, large.cases[i].seed);
  }
}

TEST(PlanTest, AShardIsAPartOfItsCount) {
  EXPECT_TRUE(parse_shard("0/1"));
  EXPECT_TRUE(parse_shard("3/4"));
  for (const std::string bad : {"4/4", "1/0", "1", "/", "a/2", "1/2x", "-1/2", ""}) {
    EXPECT_FALSE(parse_shard(bad)) << bad;
  }
}

TEST(PlanTest, EverySetCanBeMadeIntoScenarios) {
  for (const char* name : {"table",
                           "net",
                           "mc",
                           "mc-hard",
                           "mc-noise",
                           "mc-adv",
                           "grips",
                           "inc",
                           "blackout",
                           "breath",
                           "long",
                           "faults"}) {
    const auto plan = make_set(name, {.count = 3});
    ASSERT_TRUE(plan) << name;
    EXPECT_TRUE(make_case(*plan, plan->cases.back())) << name;
  }
  EXPECT_FALSE(make_set("all", {}));
}

TEST(PlanTest, FaultsAreOfEveryKindEverywhereAndWithinTheScript) {
  const auto plan = make_set("faults", {.count = 100, .seed = 8});
  std::set<FaultKind> kinds;
  std::set<std::string_view> places;
  for (const Case& one : plan->cases) {
    kinds.insert(one.fault.kind);
    places.insert(one.fault_place);
  }
  EXPECT_EQ(kinds.size(), 5U);
  EXPECT_EQ(places.size(), kFaultPlaces.size());
  std::set<Duration> moments;
  for (std::size_t i = 0; i < 20; ++i) {
    const Scenario scenario = *make_case(*plan, plan->cases[i]);
    EXPECT_EQ(scenario.fault.kind, plan->cases[i].fault.kind);
    EXPECT_GT(scenario.fault.at_script_time, Duration{0});
    EXPECT_LT(scenario.fault.at_script_time, scenario.script.length());
    moments.insert(scenario.fault.at_script_time);
  }
  EXPECT_GE(moments.size(), kFaultPlaces.size());
}

TEST(PlanTest, ASweepIsAllCombinations) {
  const auto plan = make_sweep("standard", {"rtt_ms=0,20", "surgeon.hand.grip=mid,firm"}, 3, {});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->cases.size(), 12U);
  std::set<std::vector<std::string>> combinations;
  for (const Case& one : plan->cases) combinations.insert(one.labels);
  EXPECT_EQ(combinations.size(), 4U);
  for (const char* bad : {"rtt_ms", "=1", "rtt_ms=", "rtt_ms=1,,2"}) {
    EXPECT_FALSE(make_sweep("standard", {bad}, 1, {})) << bad;
  }
}

TEST(PlanTest, ASweepTakesTissueFromItsScenarioOrFromWhoAsks) {
  PlanAsk ask{.tissue = ""};
  auto plan = make_sweep("standard", {"rtt_ms=20"}, 1, ask);
  ASSERT_TRUE(plan);
  EXPECT_EQ(make_case(*plan, plan->cases[0])->phantom.name, plan->tissue);
  ask.tissue = "none";
  plan = make_sweep("standard", {"rtt_ms=20"}, 1, ask);
  ASSERT_TRUE(plan);
  EXPECT_EQ(make_case(*plan, plan->cases[0])->phantom.name, "none");
}

TEST(PlanTest, ARoundTripBesideTheWordsOfALinkIsRefusedNotIgnored) {
  const auto plan = make_sweep("metro", {"rtt_ms=20"}, 1, {.tissue = ""});
  ASSERT_TRUE(plan);
  const auto refused = make_case(*plan, plan->cases[0]);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("up.delay_ms"), std::string::npos) << refused.error().text;
  // Words replace the numbers of "standard".
  const auto words = make_sweep("standard", {"up.spec=delay 7ms"}, 1, {.tissue = ""});
  ASSERT_TRUE(words);
  EXPECT_TRUE(make_case(*words, words->cases[0]));
}

TEST(SpreadTest, CountsUndefinedValuesAsTheWorst) {
  std::vector<CaseResult> results(20);
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].values.assign(metric_table().size(), static_cast<double>(i));
  }
  EXPECT_EQ(spread_of(results, 0).p95, 19);
  results[0].values[0] = kUndefined;
  EXPECT_TRUE(std::isnan(spread_of(results, 0).p95));
  EXPECT_EQ(spread_of(results, 0).p50, 11);
  EXPECT_EQ(spread_of(results, 0).undefined, 1U);
}

TEST(LyingCodecTest, TellsAnotherModelEveryFiftyMilliseconds) {
  LyingCodec codec{std::make_unique<link::RawCodec>(), 3, std::chrono::milliseconds{1}};
  std::set<double> surfaces;
  for (int i = 0; i < 200; ++i) {
    std::array<std::byte, link::kTelegramSizeMax> bytes{};
    const std::size_t size = codec.encode({}, bytes);
    const auto told = codec.decode(std::span{bytes}.first(size));
    ASSERT_TRUE(told);
    surfaces.insert(std::get<ModelPayload>(told->telegram.port.payload).surface);
  }
  EXPECT_EQ(surfaces.size(), 4U);
}

}  // namespace
}  // namespace palp::lab
