#include "study/closed_loop/cue_bank.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

/// A coupling that shows `gain` of a difference, shifted by `offset`.
CueBank made(double gain, double offset, bool two_sided, double noise = 0) {
  CueBank bank;
  for (int i = two_sided ? -12 : 0; i <= 12; ++i) {
    bank.levels.push_back(0.1 * i);
    bank.differences.emplace_back();
    for (std::uint64_t k = 0; k < 40; ++k) {
      const double random = noise * random_normal(1, static_cast<std::uint64_t>(i + 20), k);
      bank.differences.back().push_back(offset + gain * bank.levels.back() + random);
    }
  }
  return bank;
}

TEST(CueBankTest, BankAndClosedFormAgreeWhereFeltFollowsTrue) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  for (const double gain : {0.4, 1.0}) {
    const CueBank bank = made(gain, 0, false);
    const FeltLine line = line_of(bank);
    EXPECT_NEAR(line.gain, gain, 1e-9);
    EXPECT_NEAR(closed_form(line, judgement, 3).jnd, std::log1p(0.15) / gain, 1e-9);
    EXPECT_NEAR(banked(bank, judgement, 3).jnd, std::log1p(0.15) / gain, 0.01);
  }
}

TEST(CueBankTest, AShiftIsABias) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  const CueBank bank = made(0.5, -0.2, true);
  EXPECT_NEAR(closed_form(line_of(bank), judgement, 3).pse, 0.4, 1e-9);
  EXPECT_NEAR(banked(bank, judgement, 3).pse, 0.4, 0.01);
  EXPECT_NEAR(banked(bank, judgement, 3).jnd, std::log1p(0.15) / 0.5, 0.02);
}

TEST(CueBankTest, ASessionsOwnNoiseMakesTheJndLarger) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  const FeltLine line = line_of(made(1, 0, false, 0.2));
  EXPECT_NEAR(line.scatter, 0.2, 0.02);
  const double sd = judgement.difference_sd(3);
  EXPECT_NEAR(closed_form(line, judgement, 3).jnd * line.gain,
              std::log1p(0.15) * std::hypot(sd, line.scatter) / sd,
              1e-9);
  EXPECT_GT(banked(made(1, 0, false, 0.2), judgement, 3).jnd,
            1.1 * banked(made(1, 0, false), judgement, 3).jnd);
}

TEST(CueBankTest, WhereNothingIsFeltNothingIsForetold) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  CueBank bank = made(1, 0, false);
  for (auto& level : bank.differences) {
    for (double& one : level) one = std::numeric_limits<double>::quiet_NaN();
  }
  EXPECT_TRUE(std::isinf(banked(bank, judgement, 3).jnd));
  EXPECT_TRUE(std::isinf(closed_form(line_of(bank), judgement, 3).jnd));
  EXPECT_DOUBLE_EQ(banked_share(bank, judgement, 3, 1), 0.5);
}

TEST(CueBankTest, ResamplesAreOfTheSameSessions) {
  const CueBank bank = made(1, 0, false, 0.2);
  const CueBank again = resampled(bank, 1, 2);
  EXPECT_NE(again.differences, bank.differences);
  for (std::size_t level = 0; level < bank.levels.size(); ++level) {
    for (const double one : again.differences[level]) {
      EXPECT_NE(std::find(bank.differences[level].begin(), bank.differences[level].end(), one),
                bank.differences[level].end());
    }
  }
}

TEST(CueBankTest, SessionsFillItBothWaysRound) {
  const auto session = FeltSession::make({.name = "mmt",
                                          .coupling = "mmt",
                                          .up = "delay_ms: 1",
                                          .down = "delay_ms: 1",
                                          .grip = "mid"});
  const Judgement judgement = judgement_of(0.15, 0, own_gain(*session));
  const CueBank bank = bank_of(
      *session, judgement, false, {0.1, 0.6}, 2, 1, [](std::size_t count, const auto& work) {
        for (std::size_t i = count; i-- > 0;) work(i);
      });
  ASSERT_EQ(bank.differences.size(), 2U);
  for (const double one : bank.differences[1]) EXPECT_NEAR(one, 0.6, 0.25);
}

}  // namespace
}  // namespace palp::study
