#include "common/core/printable.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

RC_GTEST_PROP(PrintableTest, IsOneShortLine, (const std::string& text)) {
  const std::string shown = printable(text);
  RC_ASSERT(shown.size() <= 83U);
  for (const char c : shown) {
    RC_ASSERT(c >= ' ' && c <= '~');
  }
}

TEST(PrintableTest, MarksWhereItCutsOff) {
  EXPECT_EQ(printable(std::string(80, 'a')), std::string(80, 'a'));
  EXPECT_EQ(printable(std::string(81, 'a')), std::string(80, 'a') + "...");
  EXPECT_EQ(printable("a\nb\x1b"), "a?b?");
}

}  // namespace
}  // namespace palp
