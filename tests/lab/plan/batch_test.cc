// Goal: a plan's results depend on the plan alone. Method: small sets, run whole and in shards,
// forwards and backwards.

#include "lab/plan/batch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "common/config/report.h"
#include "judge/metric_table.h"
#include "lab/plan/plan.h"
#include "lab/report/batch_report.h"
#include "lab/report/stability_map.h"
#include "lab/run/adversary.h"
#include "lab/run/valve.h"
#include "lab/verbs.h"
#include "tests/lab/empty_cases.h"
#include "tests/support/own_path.h"

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
  EXPECT_TRUE(check_complete(read, merged));
  // Set, seed, coupling and tissue included, and every number of every metric.
  EXPECT_EQ(batch_report(read, merged, {}), batch_report(small_plan(3), whole, {}));
}

TEST(MergeTest, AShardThatIsMissingOrGivenTwiceIsNoticedAlsoTheLast) {
  const Plan plan = small_plan(5);
  const std::vector<CaseResult> whole = empty_cases(plan);
  EXPECT_TRUE(check_complete(plan, whole));
  for (std::size_t gone = 0; gone < whole.size(); ++gone) {
    std::vector<CaseResult> some = whole;
    some.erase(some.begin() + static_cast<std::ptrdiff_t>(gone));
    const auto refused = check_complete(plan, some);
    ASSERT_FALSE(refused) << gone;
    EXPECT_NE(refused.error().text.find("case " + std::to_string(gone) + " of 5 is missing"),
              std::string::npos)
        << refused.error().text;
    some = whole;
    some.insert(some.begin() + static_cast<std::ptrdiff_t>(gone), whole[gone]);
    const auto twice = check_complete(plan, some);
    ASSERT_FALSE(twice) << gone;
    EXPECT_NE(twice.error().text.find("given twice"), std::string::npos) << twice.error().text;
  }
  EXPECT_FALSE(check_complete(plan, {}));
}

TEST(MergeTest, CasesOfAnotherPlanAreRefused) {
  const PlanAsk ask{.count = 4, .seed = 5};
  std::vector<PlanAsk> others(4, ask);
  others[0].count = 5;
  others[1].seed = 6;
  others[2].coupling = "wave";
  others[3].tissue = "fe";
  const Plan plan = *make_set("mc", ask);
  const std::string rows = cases_csv(plan, empty_cases(plan));
  const auto refuses = [&](const Plan& another) {
    Plan read;
    EXPECT_TRUE(read_cases_csv(rows, "one", read));
    return !read_cases_csv(cases_csv(another, empty_cases(another)), "two", read);
  };
  EXPECT_FALSE(refuses(plan));
  for (const PlanAsk& other : others) EXPECT_TRUE(refuses(*make_set("mc", other)));
  EXPECT_TRUE(refuses(*make_set("mc-hard", ask)));
  EXPECT_TRUE(refuses(*make_set("faults", ask))) << "other columns";
}

TEST(MergeTest, CommasAndQuotesInNamesSurvive) {
  Plan plan = small_plan(2);
  plan.tissue = "file:a,\"b\".csv";
  std::vector<CaseResult> results = empty_cases(plan);
  results[1].labels[0] = "\"x\",,";
  Plan read;
  const auto again = read_cases_csv(cases_csv(plan, results), "cases", read);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(read.tissue, plan.tissue);
  EXPECT_EQ(again->at(1).labels, results[1].labels);
}

TEST(MergeTest, WhoMadeTheCasesIsKept) {
  Plan plan = small_plan(3);
  plan.made_by = "one, \"compiler\"";
  std::vector<CaseResult> results = empty_cases(plan);
  results[1].made_by = "another";
  Plan read;
  const auto again = read_cases_csv(cases_csv(plan, results), "cases", read);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(makers(read, *again), (std::vector<std::string>{"another", plan.made_by}));
  EXPECT_TRUE(makers({}, empty_cases(plan)).empty());
}

TEST(MergeTest, ARowThatWasNotWrittenWholeIsRefused) {
  const Plan plan = small_plan(2);
  std::string rows = cases_csv(plan, empty_cases(plan));
  rows.erase(rows.rfind(',') - 3, 1);
  Plan read;
  const auto refused = read_cases_csv(rows, "cases", read);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("cases: line 3 was not written whole"), std::string::npos);
}

TEST(MergeTest, FilesMayBeAsLongAsTheLargestSet) {
  const Plan plan = small_plan(20'000);
  const std::string path = test::own_path("cases.csv");
  const std::string rows = cases_csv(plan, empty_cases(plan));
  ASSERT_GT(rows.size(), 2U << 20U) << "longer than settings may be";
  ASSERT_TRUE(config::write_whole_file(path, rows));
  BatchArguments arguments;
  arguments.list = {path};
  const auto exit_status = run_batch_verb("merge", arguments, {});
  (void)std::remove(path.c_str());
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, config::ExitCode::Done) << exit_status->text;
}

TEST(VerbsTest, WhatCannotBeWrittenIsRefusedBeforeTheFirstCaseIsRun) {
  std::size_t ran = 0;
  const Machine machine{.processors = 1,
                        .for_each_index = [&](std::size_t, std::size_t, const auto&) { ++ran; },
                        .used =
                            [] {
                              return std::pair{0.0, 0.0};
                            },
                        .watched = false};
  const std::string closed = "/no/such/folder/file";
  std::vector<BatchArguments> asked(4);
  asked[0].report = closed;
  asked[1].cases = closed;
  asked[2].picture.svg = closed;
  asked[3].picture.pdf = closed;
  for (const BatchArguments& arguments : asked) {
    const auto exit_status = run_batch_verb("montecarlo", arguments, machine);
    ASSERT_TRUE(exit_status);
    EXPECT_EQ(exit_status->code, config::ExitCode::CannotOpen);
    EXPECT_NE(exit_status->text.find(closed), std::string::npos);
  }
  BatchArguments sweep;
  sweep.list = {"rtt_ms=20", "surgeon.hand.grip=mid,hairy"};
  const auto exit_status = run_batch_verb("sweep", sweep, machine);
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, config::ExitCode::BadInput);
  EXPECT_EQ(ran, 0U);
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
                           "faults",
                           "pauses",
                           "device-faults",
                           "devices"}) {
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
  EXPECT_EQ(kinds.size(), 7U);
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
  for (const char* bad : {"rtt_ms", "=1", "rtt_ms=", "rtt_ms=1,,2", "seed=-1", "seed=x"}) {
    EXPECT_FALSE(make_sweep("standard", {bad}, 1, {})) << bad;
  }
  EXPECT_FALSE(make_sweep("standard", {"rtt_ms=1", "rtt_ms=2"}, 1, {})) << "which of them?";
}

TEST(PlanTest, WhatHasNoEffectInVirtualTimeIsNoAxis) {
  for (const char* idle : {"patient.seed=1,2",
                           "surgeon.impairment.delay_ms=0,50",
                           "surgeon.duration_s=3,5",
                           "loop.priority=1,2",
                           "surgeon.link.rekey_after_s=1,2",
                           "patient.record.queue_records=256,512",
                           "patient.estimator.radius_min_mm=3,5"}) {
    const auto refused = make_sweep("standard", {idle}, 1, {.tissue = ""});
    ASSERT_FALSE(refused) << idle;
    EXPECT_NE(refused.error().text.find("changes nothing"), std::string::npos);
  }
  for (const char* good :
       {"seed=1,2", "duration_s=3,5", "patient.simulated_phantom.sensor_pole_hz=20"}) {
    EXPECT_TRUE(make_sweep("standard", {good}, 1, {.tissue = ""})) << good;
  }
}

TEST(PlanTest, TheLoopsPeriodIsThatOfBothSites) {
  const auto plan = make_sweep("standard", {"loop.period_us=500,2000"}, 1, {.tissue = ""});
  ASSERT_TRUE(plan);
  const Scenario scenario = *make_case(*plan, plan->cases[1]);
  EXPECT_EQ(scenario.surgeon.period, std::chrono::milliseconds{2});
  EXPECT_EQ(scenario.patient.period, std::chrono::milliseconds{2});
}

TEST(PlanTest, SeedsCanBeAnAxis) {
  const auto plan = make_sweep("standard", {"seed=7,20"}, 2, {.tissue = ""});
  ASSERT_TRUE(plan);
  std::vector<std::uint64_t> seeds;
  for (const Case& one : plan->cases) seeds.push_back(make_case(*plan, one)->seed);
  EXPECT_EQ(seeds, (std::vector<std::uint64_t>{7, 8, 20, 21}));
}

TEST(PlanTest, ARoundTripIsANumberOfMillisecondsThatAPathCanHave) {
  for (const char* good : {"0", "2.5", "10000"}) {
    const auto plan = make_sweep("standard", {std::string{"rtt_ms="} + good}, 1, {.tissue = ""});
    EXPECT_TRUE(make_case(*plan, plan->cases[0])) << good;
  }
  for (const char* bad : {"nan", "inf", "-4", "1e400", "10001", "20ms", "0x10", " 5"}) {
    const auto plan = make_sweep("standard", {std::string{"rtt_ms="} + bad}, 1, {.tissue = ""});
    const auto refused = make_case(*plan, plan->cases[0]);
    ASSERT_FALSE(refused) << bad;
    EXPECT_NE(refused.error().text.find(bad), std::string::npos) << refused.error().text;
  }
}

TEST(PlanTest, ASweepSaysWhichCouplingItsCasesHave) {
  const auto coupling = [](const char* scenario, const char* axis, const char* asked) {
    const PlanAsk ask{.coupling = asked, .tissue = ""};
    return make_sweep(scenario, {axis}, 1, ask)->coupling;
  };
  EXPECT_EQ(coupling("far", "seed=1", ""), "direct");
  EXPECT_EQ(coupling("standard", "seed=1", "tdpa"), "tdpa");
  EXPECT_EQ(coupling("standard", "coupling.name=wave,mmt", ""), "") << "not one";
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
    results[i].values.assign(judge::metric_table().size(), static_cast<double>(i));
  }
  EXPECT_EQ(spread_of(results, 0).p90, 18);
  EXPECT_EQ(spread_of(results, 0).p95, 19);
  EXPECT_EQ(spread_of(results, 0).p99, 19);
  results[0].values[0] = judge::kUndefined;
  EXPECT_TRUE(std::isnan(spread_of(results, 0).p95));
  EXPECT_EQ(spread_of(results, 0).p90, 19);
  EXPECT_EQ(spread_of(results, 0).p50, 11);
  EXPECT_EQ(spread_of(results, 0).undefined, 1U);
}

/// What the peer reads of 200 telegrams of a site whose law says `honest`.
std::vector<PortSample> lies(const CouplingPayload& honest) {
  LyingCodec codec{std::make_unique<link::RawCodec>(), 3, std::chrono::milliseconds{1}};
  std::vector<PortSample> told;
  for (int i = 0; i < 200; ++i) {
    WireTelegram telegram;
    telegram.telegram.port.payload = honest;
    std::array<std::byte, message::kTelegramSizeMax> bytes{};
    const std::size_t size = codec.encode(telegram, bytes);
    const auto read = codec.decode(std::span{bytes}.first(size));
    EXPECT_TRUE(read);
    if (read) told.push_back(read->telegram.port);
  }
  return told;
}

TEST(LyingCodecTest, TellsAnotherModelEveryFiftyMilliseconds) {
  std::set<double> surfaces;
  for (const PortSample& port : lies(ModelPayload{})) {
    surfaces.insert(std::get<ModelPayload>(port.payload).surface);
  }
  EXPECT_EQ(surfaces.size(), 4U);
}

TEST(LyingCodecTest, LiesInTheWordsOfEveryLaw) {
  for (const CouplingPayload& honest :
       {CouplingPayload{}, CouplingPayload{WavePayload{}}, CouplingPayload{TdpaPayload{}}}) {
    std::set<double> forces;
    for (const PortSample& port : lies(honest)) {
      EXPECT_EQ(port.payload.index(), honest.index());
      forces.insert(port.force);
    }
    EXPECT_EQ(forces.size(), 4U);
  }
  EXPECT_GT(std::get<WavePayload>(lies(WavePayload{}).back().payload).wave_energy, 100);
  EXPECT_GT(std::get<TdpaPayload>(lies(TdpaPayload{}).back().payload).energy_in, 100);
}

}  // namespace
}  // namespace palp::lab
