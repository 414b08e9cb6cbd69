#include "study/known_truth.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(KnownTruthTest, EveryMethodAndEverySensitivityHasItsTargets) {
  const auto targets = known_truth(4, 1, test::one_after_the_other);
  EXPECT_EQ(targets.size(), 2U + 4U + 3U * 4U);
  const std::string text = targets_text(targets);
  for (const char* what : {"quest-plus: sd", "staircase: intervals", "d' 2.0: bias of criterion"}) {
    EXPECT_NE(text.find(what), std::string::npos) << what;
  }
}

TEST(KnownTruthTest, ATargetHoldsBetweenItsLimits) {
  EXPECT_TRUE((Target{"", 0.93, 0.93, 0.97}.holds()));
  EXPECT_FALSE((Target{"", 0.929, 0.93, 0.97}.holds()));
  EXPECT_FALSE((Target{"", 0.971, 0.93, 0.97}.holds()));
  const std::vector<Target> missed{{"bias", 1, -0.03, 0.03}};
  EXPECT_NE(targets_text(missed).find("MISSED"), std::string::npos);
}

}  // namespace
}  // namespace palp::study
