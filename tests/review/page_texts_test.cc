#include "review/page_texts.h"

#include <gtest/gtest.h>

namespace palp::review {
namespace {

TEST(PageTextsTest, TheProgramHoldsThePageAndItsLibraryWithLicence) {
  EXPECT_NE(page_text("report").find("/*DATA*/"), std::string_view::npos);
  EXPECT_NE(page_text("uplot-code").find("uPlot"), std::string_view::npos);
  EXPECT_NE(page_text("uplot-style").find(".uplot"), std::string_view::npos);
  EXPECT_NE(page_text("uplot-license").find("MIT"), std::string_view::npos);
  EXPECT_EQ(page_text("nothing"), "");
}

}  // namespace
}  // namespace palp::review
