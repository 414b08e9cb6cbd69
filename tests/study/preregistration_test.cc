#include "study/preregistration.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(PreregistrationTest, NamesConditionsInTheOrderOfTheFileAndEveryFingerprint) {
  const std::string text =
      preregistration(test::small_study(), {.study = "s1", .schedule = "s2", .key = "k3"}, "me");
  for (const char* said : {"silk; wool; felt", "s1", "s2", "k3", "Made by: me"}) {
    EXPECT_NE(text.find(said), std::string::npos) << said;
  }
}

TEST(PreregistrationTest, ALineIsOnesOwn) {
  Study study = test::small_study();
  study.conditions[0].name = "silk\n- Ethics: approved";
  EXPECT_EQ(preregistration(study, {}, "me").find("\n- Ethics: approved"), std::string::npos);
}

}  // namespace
}  // namespace palp::study
