#include "surgeon_site/devices/master_plan.h"

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

TEST(MasterPlanTest, EachKnownMasterHasAFlagAnAddressAndAProtocol) {
  for (const KnownMaster& one : known_masters()) {
    EXPECT_EQ(master_named(one.flag), &one);
    EXPECT_EQ(addresses_of(one.kind).empty(), one.kind == MasterKind::ShaftMotor);
    MasterPlan plan;
    plan.product = &one;
    EXPECT_NE(make_protocol(plan), nullptr) << one.name;
  }
  EXPECT_EQ(master_named("script:standard"), nullptr);
}

}  // namespace
}  // namespace palp::surgeon
