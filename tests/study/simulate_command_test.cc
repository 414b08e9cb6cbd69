#include "study/simulate_command.h"

#include <gtest/gtest.h>

namespace palp::study {
namespace {

void one_after_the_other(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
}

TEST(SimulateCommandTest, EverySetEndsWellAndRepeatsItself) {
  for (const char* set : {"recover", "group", "yes-no"}) {
    SimulateFlags flags;
    flags.set = set;
    flags.observers = 4;
    flags.participants = 3;
    flags.trials = 10;
    const auto one = run_simulate(flags, one_after_the_other);
    EXPECT_EQ(one.code, config::ExitCode::Done) << set;
    EXPECT_EQ(one.text, run_simulate(flags, one_after_the_other).text) << set;
    flags.seed = 2;
    EXPECT_NE(one.text, run_simulate(flags, one_after_the_other).text) << set;
  }
}

TEST(SimulateCommandTest, ARangeThatIsNoneIsRefused) {
  SimulateFlags flags;
  flags.jnd_min = 0.5;
  EXPECT_EQ(run_simulate(flags, one_after_the_other).code, config::ExitCode::BadInput);
  flags = {};
  flags.lapse_min = 0.06;
  EXPECT_EQ(run_simulate(flags, one_after_the_other).code, config::ExitCode::BadInput);
}

TEST(SimulateCommandTest, PowerSaysHowMany) {
  EXPECT_EQ(run_power({.ratio = 1.25, .sd = 0.35, .power = 0.8}).text, "22 participants\n");
}

}  // namespace
}  // namespace palp::study
