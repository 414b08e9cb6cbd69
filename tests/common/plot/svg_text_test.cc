#include "common/plot/svg_text.h"

#include <gtest/gtest.h>

namespace palp::plot {
namespace {

TEST(SvgTextTest, WordsCannotBreakThePicture) {
  std::string text = open_picture(100, 50);
  label(text, 1, 2, "start", "a < b & c");
  title(text, 1, 2, "<script>");
  label(text, 1, 2, "end", "x\x1b[2J\x01");
  EXPECT_NE(text.find("x?[2J?"), std::string::npos) << "no XML with control characters";
  EXPECT_NE(text.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(text.find("<script>"), std::string::npos);
}

}  // namespace
}  // namespace palp::plot
