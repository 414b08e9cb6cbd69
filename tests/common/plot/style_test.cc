#include "common/plot/style.h"

#include <gtest/gtest.h>

namespace palp::plot {
namespace {

TEST(StyleTest, ColumnsOfAPaperAreAsWideAsJournalsSay) {
  ASSERT_TRUE(style_of("single") && style_of("double") && style_of("screen"));
  EXPECT_NEAR(style_of("single")->width / kPointsPerMillimetre, 85, 1e-9);
  EXPECT_NEAR(style_of("double")->width / kPointsPerMillimetre, 175, 1e-9);
  EXPECT_FALSE(style_of("triple"));
  EXPECT_FALSE(style_of(""));
}

}  // namespace
}  // namespace palp::plot
