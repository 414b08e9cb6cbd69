#include "fem/paper_command.h"

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

/// Cubics alone, nothing solved: h as given.
PaperPhantom phantom(double depth_mm, double hash_n) {
  PaperPhantom out;
  out.depth_mm = depth_mm;
  out.indentations_mm = {0, 2, 4};
  out.cubic.coefficients = {-0.0025, 0.03, 0.035, hash_n - 0.0625};
  for (const double d : out.indentations_mm) out.forces_n.push_back(out.cubic.force(d));
  return out;
}

PaperStudy study() {
  PaperStudy out;
  out.phantoms = {phantom(5, 0.092), phantom(10, 0.069), phantom(15, 0.0638)};
  out.plain = phantom(0, 0.0591);
  out.refitted = kPaperFormula;
  return out;
}

TEST(PaperCommandTest, MissesAHashThatIsOnePerCentOff) {
  EXPECT_TRUE(paper_misses(study()).empty());
  PaperStudy off = study();
  off.phantoms[1] = phantom(10, 0.0691126 * 1.011);
  ASSERT_EQ(paper_misses(off).size(), 1U);
  EXPECT_NE(paper_misses(off)[0].find("10 mm"), std::string::npos);
  off.plain = phantom(0, 0.0598);
  EXPECT_EQ(paper_misses(off).size(), 2U);
}

TEST(PaperCommandTest, TellsTheTableBesideThePapersNumbers) {
  const std::string text = paper_text(study());
  for (const char* number : {"0.092020", "13.2451", "0.065410", "Table I"}) {
    EXPECT_NE(text.find(std::string{number}.substr(0, 8)), std::string::npos) << number;
  }
  EXPECT_NE(paper_report(study()).find("\"schema\": \"palp.paper/1\""), std::string::npos);
}

TEST(PaperCommandTest, ThePictureShowsBothFigures) {
  const std::string svg = plot::figure_svg(paper_figure(study()), plot::kStyles.front());
  for (const char* name : {"Fig. 5", "Fig. 8", ">5 mm deep<", ">no inclusion<"}) {
    EXPECT_NE(svg.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace palp::fem
