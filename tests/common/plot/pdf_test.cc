#include "common/plot/pdf.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "common/plot/figure.h"

namespace palp::plot {
namespace {

TEST(PdfTest, AColumnOfAPaperIsAPageOfItsWidth) {
  const auto pdf = pdf_of(figure_svg({.panels = {{}}}, *style_of("single")));
  ASSERT_TRUE(pdf) << pdf.error().text;
  EXPECT_EQ(pdf->substr(0, 5), "%PDF-");
  const auto box = pdf->find("/MediaBox [");
  ASSERT_NE(box, std::string::npos);
  double left = 0;
  double low = 0;
  double width = 0;
  ASSERT_EQ(std::sscanf(pdf->c_str() + box, "/MediaBox [ %lf %lf %lf", &left, &low, &width), 3);
  EXPECT_NEAR(width, 85 * kPointsPerMillimetre, 0.5);
}

TEST(PdfTest, WhatIsNoPictureIsRefusedWithTheReason) {
  const auto pdf = pdf_of("no picture");
  ASSERT_FALSE(pdf);
  EXPECT_NE(pdf.error().text.find("rsvg-convert: "), std::string::npos) << pdf.error().text;
  EXPECT_FALSE(pdf.error().unreachable);
}

}  // namespace
}  // namespace palp::plot
