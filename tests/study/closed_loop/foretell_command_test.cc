#include "study/closed_loop/foretell_command.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/io/process/parallel.h"

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

TEST(ForetellTest, AFileThatIsNoStudyIsRefused) {
  EXPECT_EQ(run_foretell({.file = "/nowhere"}, for_each_index).code, config::ExitCode::CannotOpen);
}

}  // namespace
}  // namespace palp::study
