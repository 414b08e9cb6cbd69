#include "common/core/number_text.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(NumberTextTest, HasSoManyDecimalsBetweenTheWords) {
  EXPECT_EQ(number_text("force ", 0.4821, 2, " N"), "force 0.48 N");
  EXPECT_EQ(number_text("", -12.96, 1, ""), "-13.0");
  const std::string words(300, 'w');
  EXPECT_EQ(number_text(words.c_str(), 1e300, 0, words.c_str()).size(), 901);
}

TEST(NumberTextTest, IsNeverMinusZero) {
  EXPECT_EQ(number_text("", -0.0049, 2, ""), "0.00");
  EXPECT_EQ(number_text("", -0.0051, 2, ""), "-0.01");
}

}  // namespace
}  // namespace palp
