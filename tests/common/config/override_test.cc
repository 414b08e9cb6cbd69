#include "common/config/override.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "proto/config.pb.h"

namespace palp::config {
namespace {

using proto::config::PatientConfig;
using testing::HasSubstr;

std::string error_of(std::string_view assignment) {
  PatientConfig patient;
  const auto applied = apply_override(assignment, patient);
  EXPECT_EQ(applied.has_value(), patient.ByteSizeLong() > 0) << "an error changes nothing";
  return applied ? "" : applied.error().text;
}

TEST(OverrideTest, SetsFieldsOfEveryKind) {
  PatientConfig patient;
  ASSERT_TRUE(apply_override("motion_gate.travel_min_mm=-12.5", patient));
  ASSERT_TRUE(apply_override("loop.priority=0", patient));
  ASSERT_TRUE(apply_override("seed=9007199254740991", patient));
  ASSERT_TRUE(apply_override("loop.lock_memory=false", patient));
  ASSERT_TRUE(apply_override("simulated_phantom.phantom=file:a=b.csv", patient));
  EXPECT_EQ(patient.motion_gate().travel_min_mm(), -12.5);
  EXPECT_TRUE(patient.loop().has_priority());
  EXPECT_EQ(patient.loop().priority(), 0U);
  EXPECT_EQ(patient.seed(), 9007199254740991U);
  EXPECT_FALSE(patient.loop().lock_memory());
  EXPECT_EQ(patient.simulated_phantom().phantom(), "file:a=b.csv");
}

TEST(OverrideTest, TakesSharesInPerCent) {
  PatientConfig patient;
  ASSERT_TRUE(apply_override("impairment.loss=5%", patient));
  EXPECT_EQ(patient.impairment().loss(), 0.05);
  EXPECT_EQ(error_of("impairment.loss=101%"),
            "impairment.loss = 1.01 is out of range: 0 to 1 (0% to 100%)");
  EXPECT_THAT(error_of("impairment.delay_ms=5%"), HasSubstr("is not a number"));
}

TEST(OverrideTest, LaterBeatsEarlier) {
  PatientConfig patient;
  ASSERT_TRUE(apply_override("seed=1", patient));
  ASSERT_TRUE(apply_override("seed=2", patient));
  EXPECT_EQ(patient.seed(), 2U);
}

TEST(OverrideTest, NamesFieldValueAndRange) {
  EXPECT_EQ(error_of("motion_gate.force_limit_n=12"),
            "motion_gate.force_limit_n = 12 is out of range: 0.1 to 10 N");
  EXPECT_EQ(error_of("seed=9007199254740992"),
            "seed = 9007199254740992 is out of range: 0 to 9007199254740991");
  EXPECT_EQ(error_of("estimator.kind=bayesian"),
            "estimator.kind = \"bayesian\" is not one of: bayes, paper");
}

TEST(OverrideTest, RefusesValuesOfAnotherKind) {
  EXPECT_EQ(error_of("motion_gate.force_limit_n=3N"),
            "motion_gate.force_limit_n = 3N is not a number: contact force above which the stage "
            "withdraws [N], 0.1 to 10, default 3");
  for (const char* value : {"", "nan", "inf", "1e999", " 3", "3 ", "0x3"}) {
    EXPECT_THAT(error_of(std::string{"motion_gate.force_limit_n="} + value),
                HasSubstr("is not a number"));
  }
  for (const char* value : {"", "-1", "4294967296", "1.5", "1e2"}) {
    EXPECT_THAT(error_of(std::string{"loop.priority="} + value),
                HasSubstr("is not a whole number"));
  }
  EXPECT_EQ(error_of("loop.lock_memory=1"), "loop.lock_memory = 1 is neither true nor false");
}

TEST(OverrideTest, RefusesPathsThatLeadNowhere) {
  EXPECT_THAT(
      error_of("motion_gate.force=3"),
      HasSubstr("there is no field \"force\" in \"motion_gate.force\", there are: travel_min_mm"));
  EXPECT_EQ(
      error_of("motion_gate=3"),
      "motion_gate is a group of fields: name one of them, such as motion_gate.travel_min_mm");
  EXPECT_EQ(error_of("seed.x=3"), "seed.x: seed has no fields of its own");
  for (const char* assignment : {"", "=", "=3", "seed", ".=3", "loop.=3", ".seed=3", "loop..x=3"}) {
    EXPECT_NE(error_of(assignment), "") << assignment;
  }
}

RC_GTEST_PROP(OverrideTest, GarbageGetsOneSentence, (const std::string& text)) {
  for (const std::string& assignment : {text, "motion_gate.force_limit_n=" + text}) {
    const std::string error = error_of(assignment);
    RC_ASSERT(error.find('\n') == std::string::npos);
  }
}

}  // namespace
}  // namespace palp::config
