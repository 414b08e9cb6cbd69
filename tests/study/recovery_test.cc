#include "study/recovery.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

void one_after_the_other(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
}

// A known truth comes back: 200 observers, JND 0.08 to 0.30, lapses to 5 %. Four standard errors.
TEST(RecoveryTest, EveryMethodFindsTheJndAndItsIntervalsHold) {
  constexpr std::size_t kObservers = 200;
  for (const MethodKind kind :
       {MethodKind::Constant, MethodKind::Staircase, MethodKind::Quest, MethodKind::QuestPlus}) {
    RecoverySet set;
    set.method.kind = kind;
    const auto cases = recover(set, kObservers, one_after_the_other);
    const RecoverySummary found = summary_of(set, cases);
    EXPECT_NEAR(found.bias, 0, 4 * found.sd / std::sqrt(double{kObservers})) << to_string(kind);
    EXPECT_NEAR(found.held, 0.95, 4 * std::sqrt(0.95 * 0.05 / kObservers)) << to_string(kind);
    EXPECT_GT(found.sd, 0.85 * found.bound) << to_string(kind);
    if (kind == MethodKind::QuestPlus) {
      EXPECT_LT(found.sd, 1.3 * found.bound);
    }
  }
}

TEST(RecoveryTest, ObserversDoNotDependOnTheirOrder) {
  const RecoverySet set;
  const auto forwards = recover(set, 6, one_after_the_other);
  const auto backwards = recover(set, 6, [](std::size_t count, const auto& work) {
    for (std::size_t i = count; i-- > 0;) work(i);
  });
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(forwards[i].ln_jnd.mean, backwards[i].ln_jnd.mean);
  }
}

// Where conditions do not differ, about 5 in 100 experiments say so; where they differ much, most.
TEST(RecoveryTest, GroupsFindWhatIsThereAndSeldomWhatIsNot) {
  GroupSet set;
  set.participants = 8;
  set.observers.method.stop = {.trials_min = 20, .trials_max = 20};
  const GroupSummary none = repeat_group(set, 60, one_after_the_other);
  EXPECT_LE(none.found, 0.05 + 4 * std::sqrt(0.05 * 0.95 / 60));
  EXPECT_LE(none.equal, 0.5);
  set.condition_ln = std::log(2.5);
  const GroupSummary much = repeat_group(set, 20, one_after_the_other);
  EXPECT_GT(much.found, 0.8);
  EXPECT_EQ(much.equal, 0);
}

TEST(RecoveryTest, YesAndNoGiveBackSensitivityAndCriterion) {
  constexpr std::size_t kObservers = 600;
  const double error = 4 * std::sqrt(0.05 * 0.95 / kObservers);
  for (const double d_prime : {1.0, 2.0}) {
    const YesNoSummary found = recover_yes_no(d_prime, 0.3, 60, kObservers, 5);
    EXPECT_NEAR(found.d_prime_bias, 0, 0.06) << d_prime;
    EXPECT_NEAR(found.criterion_bias, 0, 0.03) << d_prime;
    EXPECT_NEAR(found.d_prime_held, 0.95, error) << d_prime;
    EXPECT_NEAR(found.criterion_held, 0.95, error) << d_prime;
  }
}

}  // namespace
}  // namespace palp::study
