#include "common/settings/site_settings.h"

#include <gtest/gtest.h>

#include "common/settings/units.h"
#include "proto/config.pb.h"
#include "tests/common/settings/settings_text.h"

namespace palp::settings {
namespace {

TEST(SiteSettingsTest, EmptyMessagesGiveTheDefaultsOfTheParts) {
  settings_test::FieldList made;
  add(made, make_coupling({}).value());
  add(made, make_link({}, std::chrono::milliseconds{1}));
  add(made, make_loop({}));
  add(made, make_impairment({}));
  add(made, make_record({}).value());
  add(made, make_monitor({}));
  settings_test::FieldList defaults;
  add(defaults, coupling::CouplingConfig{});
  add(defaults, link::LinkConfig{});
  add(defaults, LoopSettings{});
  add(defaults, ImpairmentSettings{});
  add(defaults, RecordSettings{});
  add(defaults, MonitorSettings{});
  EXPECT_EQ(made.text(), defaults.text());
}

TEST(SiteSettingsTest, AnyOfItsKnobsMakesAnImpairment) {
  EXPECT_FALSE(ImpairmentSettings{}.any());
  EXPECT_TRUE(ImpairmentSettings{.spec = "none"}.any());
  EXPECT_TRUE(ImpairmentSettings{.delay = Duration{1}}.any());
  EXPECT_TRUE(ImpairmentSettings{.jitter = Duration{1}}.any());
  EXPECT_TRUE(ImpairmentSettings{.loss = 0.1}.any());
}

TEST(SiteSettingsTest, UnitsOfTheBorderBecomeSi) {
  EXPECT_EQ(from_milli(3), 3e-3);
  EXPECT_EQ(from_micro(30), 30e-6);
  EXPECT_EQ(from_milliseconds(0.25), std::chrono::microseconds{250});
  EXPECT_EQ(from_microseconds(1.5), std::chrono::nanoseconds{1500});
}

TEST(SiteSettingsTest, AnotherPeriodOrLawIsAnotherAgreement) {
  const proto::config::Coupling coupling;
  const std::uint64_t agreement = agreement_hash(coupling, std::chrono::milliseconds{1});
  EXPECT_EQ(agreement_hash(coupling, std::chrono::milliseconds{1}), agreement);
  EXPECT_NE(agreement_hash(coupling, std::chrono::milliseconds{2}), agreement);
  proto::config::Coupling softer;
  softer.mutable_direct()->set_spring_n_per_m(100);
  EXPECT_NE(agreement_hash(softer, std::chrono::milliseconds{1}), agreement);
}

}  // namespace
}  // namespace palp::settings
