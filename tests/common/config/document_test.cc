#include "common/config/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/config.pb.h"

namespace palp::config {
namespace {

using testing::HasSubstr;

TEST(DocumentTest, HoldsTheSettingsOfItsProgram) {
  Document document = patient_document();
  ASSERT_TRUE(document.merge("seed: 5", "a.conf"));
  ASSERT_TRUE(document.set("motion_gate.force_limit_n=2"));
  ASSERT_TRUE(document.set("impairment.delay_ms", "10", "--delay-ms"));
  ASSERT_TRUE(document.check());
  const auto& patient = document.as<proto::config::PatientConfig>();
  EXPECT_EQ(patient.seed(), 5U);
  EXPECT_EQ(patient.motion_gate().force_limit_n(), 2);
  EXPECT_EQ(patient.impairment().delay_ms(), 10);
  EXPECT_EQ(patient.motion_gate().force_stop_n(), 5) << "the default";
}

TEST(DocumentTest, NamesTheFlagInsteadOfTheField) {
  Document document = patient_document();
  EXPECT_EQ(document.set("impairment.delay_ms", "5001", "--delay-ms").error().text,
            "--delay-ms = 5001 is out of range: 0 to 5000 ms");
}

TEST(DocumentTest, BothSitesAgreeOnTheHashOfWhatTheyShare) {
  Document surgeon = surgeon_document();
  Document patient = patient_document();
  EXPECT_EQ(surgeon.hash("coupling"), patient.hash("coupling"));
  EXPECT_NE(surgeon.hash(), patient.hash());
  ASSERT_TRUE(surgeon.set("engagement.forced=true"));
  ASSERT_TRUE(surgeon.set("seed=2"));
  EXPECT_EQ(surgeon.hash("coupling"), patient.hash("coupling")) << "local matters";
  ASSERT_TRUE(surgeon.set("coupling.direct.spring_n_per_m=201"));
  EXPECT_NE(surgeon.hash("coupling"), patient.hash("coupling"));
}

TEST(DocumentTest, DescribesItsFields) {
  const Document document = surgeon_document();
  EXPECT_THAT(document.describe(), HasSubstr("  hand.grip\n"));
  EXPECT_THAT(document.describe("impairment.delay_ms"), HasSubstr("[ms], 0 to 5000, default 0"));
  EXPECT_TRUE(document.is_switch("link.insecure"));
  EXPECT_FALSE(document.is_switch("seed"));
}

TEST(DocumentTest, AScenarioHoldsBothSites) {
  Document document = scenario_document();
  ASSERT_TRUE(document.merge("patient { seed: 3 } up { delay_ms: 10 }", "a.textproto"));
  EXPECT_EQ(document.as<proto::config::LabScenario>().patient().seed(), 3U);
  EXPECT_THAT(document.text(), HasSubstr("delay_ms: 10"));
}

TEST(DocumentDeathTest, AWrongPathInAProgramIsOurBug) {
  const Document document = patient_document();
  EXPECT_DEATH((void)document.describe("motion_gate.nothing"), "names a field");
  EXPECT_DEATH((void)document.as<proto::config::SurgeonConfig>(), "another kind");
}

}  // namespace
}  // namespace palp::config
