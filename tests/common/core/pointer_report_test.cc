#include "common/core/pointer_report.h"

#include <gtest/gtest.h>

#include "common/core/mailbox.h"

namespace palp {
namespace {

TEST(PointerReportTest, BeforeTheFirstNobodyHoldsAnything) {
  Mailbox<PointerReport> reports;
  EXPECT_FALSE(reports.get().held);
  EXPECT_EQ(reports.get().press, 0U);
}

}  // namespace
}  // namespace palp
