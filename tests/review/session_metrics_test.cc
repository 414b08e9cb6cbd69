#include "review/session_metrics.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/review/lab_files.h"
#include "tests/support/own_path.h"

namespace palp::review {
namespace {

using std::chrono_literals::operator""s;

struct Judged {
  JudgedSession session;
  judge::RunMetrics review;
  judge::RunMetrics lab;
};

/// The lab judges by true states; the review too, unless `logged` has only what sites write down.
Judged judged(const lab::Scenario& scenario, bool logged) {
  test::LabFiles files;
  Judged made;
  made.lab =
      lab::simulate(scenario, {.surgeon = &files.surgeon, .patient = &files.patient}).metrics;
  auto surgeon = load_site(files.surgeon.bytes(), "s", link::Role::Surgeon).value();
  if (logged) surgeon.run_began.reset();
  auto patient = load_site(files.patient.bytes(), "p", link::Role::Patient).value();
  const auto tissue = judge::TissueTable::parse(patient.texts.tissue_csv.value()).value();
  const SessionPair pair = pair_of(std::move(surgeon), std::move(patient)).value();
  made.session = judge_session(pair, &tissue);
  made.review = made.session.metrics;
  return made;
}

TEST(SessionMetricsTest, FindsTheLabsTapsAndForcesInTheFiles) {
  const Judged one = judged(test::lab_scenario(25s), true);
  EXPECT_TRUE(one.session.phases);
  EXPECT_FALSE(one.review.unstable);
  ASSERT_GT(one.lab.taps.size(), 1U);
  ASSERT_EQ(one.review.taps.size(), one.lab.taps.size());
  for (std::size_t i = 0; i < one.lab.taps.size(); ++i) {
    EXPECT_EQ(one.review.taps[i].index, one.lab.taps[i].index);
    // What is written down comes from an encoder, and a tick later.
    EXPECT_NEAR(one.review.taps[i].hand_max, one.lab.taps[i].hand_max, 0.1e-3);
  }
  EXPECT_NEAR(one.review.force_peak, one.lab.force_peak, 0.02);
  EXPECT_TRUE(std::isnan(one.review.whole.force_kick)) << "nobody wrote that down";
}

TEST(SessionMetricsTest, AScriptOfAFileIsTheOneThatWasPlayed) {
  const std::string file = palp::test::own_path("played.txt");
  const auto write = [&](const char* text) { std::ofstream{file} << text; };
  write("move -2 0.5\ntaps 3 4 1 0.5\nlift 1 0.5\n");
  lab::Scenario scenario = test::lab_scenario(12s, {"surgeon.hand.master=script:" + file});
  const test::LabFiles files = test::lab_files(scenario);
  const auto looked = [&] {
    auto surgeon = load_site(files.surgeon.bytes(), "s", link::Role::Surgeon).value();
    auto patient = load_site(files.patient.bytes(), "p", link::Role::Patient).value();
    const SessionPair pair = pair_of(std::move(surgeon), std::move(patient)).value();
    return metrics_json(judge_session(pair, nullptr));
  };
  const auto before = looked();
  EXPECT_FALSE(before["tap2_a_error"].is_null()) << "the script's phases are known";
  write("move -2 0.5\ntaps 6 4 0.7 0.4\nlift 1 0.5\n");
  EXPECT_EQ(looked().dump(), before.dump());
  std::filesystem::remove(file);
  EXPECT_EQ(looked().dump(), before.dump());
}

/// A light hand over a long path gets less than the tissue has, and is told so.
TEST(SessionMetricsTest, WhatTheSurgeonWasToldOfIsJudgedAsInTheLab) {
  const std::string file = palp::test::own_path("held.txt");
  std::ofstream{file} << "hold 1\nmove to B\nhold 0.5\npress 4 1 5\nlift 1 1\n";
  const lab::Scenario scenario = test::lab_scenario(12s,
                                                    {"surgeon.hand.master=script:" + file,
                                                     "surgeon.hand.grip=light",
                                                     "up.delay_ms=100",
                                                     "down.delay_ms=100"},
                                                    "standard");
  const Judged one = judged(scenario, false);
  ASSERT_TRUE(one.session.by_truth);
  EXPECT_EQ(one.lab.contact.announced, 1) << "something was short";
  EXPECT_EQ(one.review.contact.announced, one.lab.contact.announced);
  EXPECT_EQ(one.review.contact.told_in_vain, one.lab.contact.told_in_vain);
}

TEST(SessionMetricsTest, WithoutSettingsThereAreNoPhases) {
  SessionPair pair;
  const JudgedSession none = judge_session(pair, nullptr);
  EXPECT_FALSE(none.phases);
  EXPECT_TRUE(none.excursions.empty());
  EXPECT_TRUE(metrics_json(none)["drag_rms_n"].is_null());
}

}  // namespace
}  // namespace palp::review
