#include "fem/vtu.h"

#include <string>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++found;
  }
  return found;
}

TEST(VtuTest, HoldsEveryArrayOnceAndClosesWhatItOpens) {
  CurveRequest request;
  request.indentations = {1e-3};
  request.accuracy = Accuracy::Coarse;
  request.with_error = false;
  const auto curve = solve_curve(request);
  ASSERT_TRUE(curve);
  const std::string text = vtu_text(*curve, request.specimen, request.model);
  for (const char* name : {"displacement_mm", "von_mises_kpa", "material", "connectivity"}) {
    EXPECT_EQ(count(text, std::string{"Name=\""} + name + "\""), 1U) << name;
  }
  EXPECT_EQ(count(text, "<DataArray"), count(text, "</DataArray>"));
  EXPECT_NE(text.find("NumberOfCells=\"" + std::to_string(curve->mesh.elements.size()) + "\""),
            std::string::npos);
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace palp::fem
