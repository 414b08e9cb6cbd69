#include "lab/impedance_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::lab {
namespace {

using testing::HasSubstr;

/// One after the other.
Machine machine() {
  return {.processors = 1,
          .for_each_index =
              [](std::size_t count, std::size_t /*threads*/, const auto& work) {
                for (std::size_t i = 0; i < count; ++i) work(i);
              },
          .used = {},
          .watched = false};
}

TEST(ImpedanceCommandTest, MeasuresEachLawRoundTripAndFrequency) {
  ImpedanceFlags flags;
  flags.round_trips_ms = "0,20";
  flags.frequencies_hz = "2";
  flags.stiffnesses = "300";
  const auto all = run_impedance(flags, machine());
  EXPECT_EQ(all.code, config::ExitCode::Done);
  EXPECT_EQ(std::count(all.text.begin(), all.text.end(), '\n'), 2 + 4 * 2);
  flags.coupling = "mmt";
  const auto one = run_impedance(flags, machine());
  EXPECT_EQ(std::count(one.text.begin(), one.text.end(), '\n'), 2 + 2);
  EXPECT_THAT(one.text, HasSubstr("not linear"));
}

TEST(ImpedanceCommandTest, RefusesInASentence) {
  for (const auto& [flag, list] : {std::pair{&ImpedanceFlags::round_trips_ms, "--rtt-ms"},
                                   std::pair{&ImpedanceFlags::frequencies_hz, "--frequency-hz"},
                                   std::pair{&ImpedanceFlags::stiffnesses, "--stiffness"}}) {
    ImpedanceFlags flags;
    flags.*flag = "1,x";
    const auto refused = run_impedance(flags, machine());
    EXPECT_EQ(refused.code, config::ExitCode::BadInput);
    EXPECT_THAT(refused.text, HasSubstr(list));
  }
}

}  // namespace
}  // namespace palp::lab
