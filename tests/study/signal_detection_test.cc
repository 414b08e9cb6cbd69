#include "study/signal_detection.h"

#include <gtest/gtest.h>

namespace palp::study {
namespace {

TEST(SignalDetectionTest, WhoGuessesIsInsensitive) {
  const Sensitivity found = sensitivity({30, 60, 30, 60});
  EXPECT_NEAR(found.d_prime, 0, 1e-12);
  EXPECT_NEAR(found.criterion, 0, 1e-12);
}

TEST(SignalDetectionTest, SayingYesMoreOftenMovesTheCriterionAlone) {
  const Sensitivity careful = sensitivity({500, 1000, 23, 1000});    // z: 0 and -2
  const Sensitivity careless = sensitivity({977, 1000, 500, 1000});  // z: 2 and 0
  EXPECT_NEAR(careful.d_prime, careless.d_prime, 1e-9);
  EXPECT_NEAR(careful.criterion, -careless.criterion, 1e-9);
  EXPECT_GT(careful.criterion, 0);
}

TEST(SignalDetectionTest, AnswersWithoutAMistakeStayFinite) {
  const Sensitivity found = sensitivity({20, 20, 0, 20});
  EXPECT_GT(found.d_prime, 3);
  EXPECT_LT(found.d_prime, 6);
  EXPECT_GT(found.d_prime_sd, 0.3);
}

TEST(SignalDetectionTest, FourTimesTheTrialsHalveTheError) {
  const Sensitivity few = sensitivity({80, 100, 30, 100});
  const Sensitivity many = sensitivity({320, 400, 120, 400});
  EXPECT_NEAR(many.d_prime_sd / few.d_prime_sd, 0.5, 0.01);
  EXPECT_DOUBLE_EQ(many.criterion_sd, many.d_prime_sd / 2);
}

}  // namespace
}  // namespace palp::study
