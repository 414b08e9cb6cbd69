#include "common/plot/svg_text.h"

#include <gtest/gtest.h>

namespace palp::plot {
namespace {

TEST(SvgTextTest, WordsCannotBreakThePicture) {
  std::string text = open_picture(kStyles.front(), 50);
  label(text, 1, 2, "start", "a < b & c");
  title(text, 1, 2, "<script>");
  label_upward(text, 1, 2, "<upward>");
  label(text, 1, 2, "end", "x\x1b[2J\x01");
  EXPECT_NE(text.find("x?[2J?"), std::string::npos) << "no XML with control characters";
  EXPECT_NE(text.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(text.find("<script>"), std::string::npos);
  EXPECT_EQ(text.find("<upward>"), std::string::npos);
}

TEST(SvgTextTest, APictureForPaperHasItsSize) {
  EXPECT_NE(open_picture(*style_of("single"), 100).find(" width=\"240.94pt\" height=\"100.00pt\""),
            std::string::npos);
  EXPECT_EQ(open_picture(*style_of("screen"), 100).find("height=\"100.00pt\""), std::string::npos);
}

TEST(SvgTextTest, ALetterOfSeveralBytesIsOneLetterWide) {
  EXPECT_EQ(width_of("\u2212", 10), width_of("-", 10));
  EXPECT_EQ(width_of("ab", 10), 2 * width_of("a", 10));
}

}  // namespace
}  // namespace palp::plot
