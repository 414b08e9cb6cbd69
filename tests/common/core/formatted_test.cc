#include "common/core/formatted.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(FormattedTest, WritesAsPrintfDoes) {
  EXPECT_EQ(formatted("%.1f mm at %d,%d: %s", 4.25, 17, -4, "found"), "4.2 mm at 17,-4: found");
  EXPECT_EQ(formatted("%s", ""), "");
}

TEST(FormattedTest, CutsNothingOff) {
  const std::string longer(1000, 'x');
  EXPECT_EQ(formatted("<%s>", longer.c_str()), "<" + longer + ">");
}

}  // namespace
}  // namespace palp
