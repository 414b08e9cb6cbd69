#include "study/closed_loop/foretell_command.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "common/config/json.h"
#include "common/core/whole_file.h"
#include "common/io/process/parallel.h"
#include "tests/support/own_path.h"

namespace palp::study {
namespace {

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  io::for_each_index(count, io::processors(), work);
}

Study study_of(const std::string& condition) {
  return *parse_study("seed: 3 trials: 20 condition { name: \"one\" " + condition + " }", "study");
}

// A closed loop: whole sessions show what few of them foretold, and nothing where nothing is felt.
TEST(ForetellTest, WholeSessionsShowWhatWasForetold) {
  const ForetellFlags flags{.sessions = 4, .observers = 4};
  const auto felt =
      foretell(study_of("up { delay_ms: 1 } down { delay_ms: 1 }"), 0, flags, for_each_index);
  ASSERT_TRUE(felt);
  EXPECT_EQ(felt->trials, 80U);
  EXPECT_TRUE(felt->holds(false)) << felt->whole_jnd.value << " " << felt->banked_jnd.value;
  EXPECT_NEAR(felt->line.gain, 1, 0.2);
  ASSERT_GT(felt->banked_shares.size(), 2U);
  EXPECT_NEAR(felt->banked_shares.front().share, 0.5, 0.15) << "no difference";
  EXPECT_GT(felt->banked_shares.back().share, 0.99);

  const auto none = foretell(study_of("feedback: \"none\""), 0, flags, for_each_index);
  EXPECT_TRUE(std::isinf(none->banked_jnd.value));
  EXPECT_NEAR(none->yes, 0.5, 0.2);
  EXPECT_DOUBLE_EQ(none->yes_foretold, 0.5);
  EXPECT_TRUE(none->holds(false));

  // A coupling that felt nothing would not pass for one that is felt.
  ForetoldRow passed_off = *felt;
  passed_off.yes = none->yes;
  passed_off.whole_jnd = none->whole_jnd;
  EXPECT_FALSE(passed_off.holds(false));
}

// The law of the noise at whole sessions: over the best link an observer of three intervals and one
// of yes or no show the JND that their noise says, and the criterion that they have.
TEST(ForetellTest, ThreePlacesAndOneShowWhatTheNoiseSays) {
  const std::string best = "up { delay_ms: 1 } down { delay_ms: 1 }";
  const ForetellFlags flags{.sessions = 4, .observers = 2};
  const Study three = *parse_study(
      "seed: 3 trials: 20 intervals: 3 condition { name: \"one\" " + best + " }", "study");
  const auto felt = foretell(three, 0, flags, for_each_index);
  ASSERT_TRUE(felt);
  EXPECT_TRUE(felt->holds(false)) << felt->whole_jnd.value << " " << felt->banked_jnd.value;
  const Judgement noise = judgement_of(flags.weber, 0, 1);
  EXPECT_NEAR(std::log(felt->closed_jnd.value * felt->line.gain),
              std::log(noise.jnd(three.task, 3, 1)),
              0.15);
  EXPECT_NEAR(felt->line.gain, 1, 0.2);

  const Study yes_no = *parse_study(
      "seed: 3 trials: 30 task: \"detect\" method: \"constant\" depth { top_mm: 5 contrast_ln: 0.5 "
      "} "
      "depth { top_mm: 8 contrast_ln: 0.25 } depth { top_mm: 10 contrast_ln: 0.12 } "
      "condition { name: \"one\" " +
          best + " }",
      "study");
  const auto told = foretell(yes_no, 0, flags, for_each_index);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->trials, 60U);
  EXPECT_TRUE(told->holds(true)) << told->whole_jnd.value << " " << told->banked_jnd.value << "; "
                                 << told->whole_pse.value << " " << told->banked_pse.value;
  EXPECT_NEAR(std::log(told->closed_jnd.value * told->line.gain),
              std::log(noise.jnd(yes_no.task, 3, 1)),
              0.15);
}

// Both of few sessions may be off by chance: the fewer, the more.
TEST(ForetellTest, ChanceIsThatOfTheForecastToo) {
  const Study study = study_of("up { delay_ms: 1 } down { delay_ms: 1 }");
  const auto few = foretell(study, 0, {.sessions = 2, .observers = 1}, for_each_index);
  ASSERT_TRUE(few);
  const double of_answers =
      std::sqrt(few->yes_foretold * (1 - few->yes_foretold) / static_cast<double>(few->trials));
  EXPECT_GT(few->yes_sd, of_answers);
}

TEST(ForetellTest, ABallIsFoundDownToWhereItsContrastIsTheJnd) {
  const Study study = *parse_study(
      "task: \"detect2\" depth { top_mm: 5 contrast_ln: 0.6 } depth { top_mm: 10 contrast_ln: 0.2 "
      "} "
      "depth { top_mm: 20 contrast_ln: 0.03 } condition { name: \"one\" taps: 1 }",
      "study");
  const auto told = foretell(study, 0, {.sessions = 2, .observers = 0}, for_each_index);
  ASSERT_TRUE(told);
  ASSERT_TRUE(told->depth);
  EXPECT_NEAR(*told->depth, *depth_of(study, told->banked_jnd.value), 1e-12);
  EXPECT_GT(*told->depth, 5e-3);
}

// The estimator's number is no cue with noise: what is foretold of it are its own verdicts, and
// observers who answer by it show them.
TEST(ForetellTest, WhoAnswersByTheEstimatorShowsWhatItSays) {
  const Study study = *parse_study(
      "seed: 3 trials: 12 task: \"detect2\" method: \"constant\" depth { top_mm: 8 contrast_ln: "
      "0.2 } "
      "depth { top_mm: 12 contrast_ln: 0.08 } ball { radius_mm: 8 ratio: 100 } "
      "condition { name: \"one\" feedback: \"depth\" }",
      "study");
  const auto told = foretell(study, 0, {.sessions = 4, .observers = 2}, for_each_index);
  ASSERT_TRUE(told);
  EXPECT_TRUE(told->told);
  EXPECT_EQ(told->line.gain, 0);
  EXPECT_GT(told->yes, 0.75);
  EXPECT_TRUE(told->holds(false)) << told->yes << " " << told->yes_foretold;
}

TEST(ForetellTest, EachDisagreementIsNoticed) {
  const Estimate around{0.2, 0.18, 0.22};
  ForetoldRow row{.banked_jnd = around,
                  .closed_jnd = around,
                  .banked_pse = around,
                  .closed_pse = around,
                  .whole_jnd = around,
                  .whole_pse = around,
                  .trials = 100,
                  .yes = 0.8,
                  .yes_foretold = 0.8,
                  .yes_sd = 0.02};
  EXPECT_TRUE(row.holds(true));
  const Estimate elsewhere{0.4, 0.36, 0.44};
  for (Estimate ForetoldRow::*const part :
       {&ForetoldRow::banked_jnd, &ForetoldRow::closed_jnd, &ForetoldRow::whole_jnd}) {
    ForetoldRow other = row;
    other.*part = elsewhere;
    EXPECT_FALSE(other.holds(false));
  }
  for (Estimate ForetoldRow::*const part :
       {&ForetoldRow::banked_pse, &ForetoldRow::closed_pse, &ForetoldRow::whole_pse}) {
    ForetoldRow other = row;
    other.*part = elsewhere;
    EXPECT_FALSE(other.holds(true));
    EXPECT_TRUE(other.holds(false));
  }
  row.yes = 0.7;
  EXPECT_FALSE(row.holds(true));
}

TEST(ForetellTest, TheReportHasEachConditionsFigures) {
  const std::string file = palp::test::own_path("foretell.textproto");
  std::ofstream{file} << R"(trials: 2 condition { name: "one" taps: 1 })";
  const std::string report = file + ".json";
  (void)run_foretell({.file = file, .sessions = 2, .observers = 1, .report = report},
                     for_each_index);
  const config::Json read = config::Json::parse(read_whole_file(report).value_or(""));
  ASSERT_EQ(read.at_or_null("conditions").parts().size(), 1U);
  const config::Json& row = read["conditions"].parts().front();
  EXPECT_EQ(row["condition"].text(), "one");
  EXPECT_EQ(row["trials"].number(), 2);
  EXPECT_TRUE(row["yes_share"].number());
  EXPECT_TRUE(row["holds"].truth());
  EXPECT_EQ(row["banked_shares"].parts().size(), 8U);
}

TEST(ForetellTest, AFileThatIsNoStudyIsRefused) {
  EXPECT_EQ(run_foretell({.file = "/nowhere"}, for_each_index).code, config::ExitCode::CannotOpen);
}

}  // namespace
}  // namespace palp::study
