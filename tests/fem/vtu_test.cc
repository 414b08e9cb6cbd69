#include "fem/vtu.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

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

/// The numbers of one array; the file is plain text.
std::vector<double> array_of(const std::string& text, const std::string& name) {
  std::vector<double> out;
  const auto at = text.find("Name=\"" + name + "\"");
  if (at == std::string::npos) return out;
  const auto begin = text.find('>', at) + 1;
  std::istringstream numbers{text.substr(begin, text.find("</DataArray>", begin) - begin)};
  for (double value = 0; numbers >> value;) out.push_back(value);
  EXPECT_TRUE(numbers.eof()) << name;
  return out;
}

/// Every element closes the one opened last.
bool well_formed(const std::string& text) {
  std::vector<std::string> open;
  for (auto at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const auto end = text.find('>', at);
    if (end == std::string::npos) return false;
    if (text[at + 1] == '?' || text[end - 1] == '/') continue;
    const bool closes = text[at + 1] == '/';
    const auto from = at + (closes ? 2 : 1);
    const std::string name = text.substr(from, text.find_first_of(" >", from) - from);
    if (!closes) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return false;
    } else {
      open.pop_back();
    }
  }
  return open.empty();
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

// What VTK demands of an unstructured grid, and its order of a nine-node quadrilateral (cell type
// 28): four corners round the cell, the middles of the sides in the same sense, the centre.
TEST(VtuTest, CellsAreBiquadraticQuadrilateralsInVtksOrder) {
  CurveRequest request;
  request.specimen.inclusion = {.shape = InclusionShape::Ball, .depth = 8e-3, .radius = 5e-3};
  request.indentations = {1e-3};
  request.accuracy = Accuracy::Coarse;
  request.with_error = false;
  const auto curve = solve_curve(request);
  ASSERT_TRUE(curve);
  const std::string text = vtu_text(*curve, request.specimen, request.model);
  ASSERT_TRUE(well_formed(text));
  const std::size_t cells = curve->mesh.elements.size();
  const std::size_t points = curve->mesh.nodes.size();
  const auto connectivity = array_of(text, "connectivity");
  const auto offsets = array_of(text, "offsets");
  const auto types = array_of(text, "types");
  const auto place = array_of(text, "Points");
  ASSERT_EQ(connectivity.size(), 9 * cells);
  ASSERT_EQ(offsets.size(), cells);
  ASSERT_EQ(types.size(), cells);
  ASSERT_EQ(place.size(), 3 * points);
  EXPECT_EQ(array_of(text, "displacement_mm").size(), 3 * points);
  EXPECT_EQ(array_of(text, "von_mises_kpa").size(), points);
  EXPECT_EQ(array_of(text, "material").size(), cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    EXPECT_EQ(types[cell], 28);
    EXPECT_EQ(offsets[cell], 9 * (cell + 1));
    const auto at = [&](std::size_t k, std::size_t axis) {
      const double node = connectivity[9 * cell + k];
      EXPECT_TRUE(node >= 0 && node < static_cast<double>(points));
      return place[3 * static_cast<std::size_t>(node) + axis];
    };
    double area = 0;
    double size = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      area += 0.5 * (at(k, 0) * at(next, 1) - at(next, 0) * at(k, 1));
      size = std::max(size, std::hypot(at(next, 0) - at(k, 0), at(next, 1) - at(k, 1)));
    }
    EXPECT_GT(area, 0);                    // counter-clockwise
    for (std::size_t k = 0; k < 4; ++k) {  // a middle lies between its two corners
      for (const std::size_t axis : {0U, 1U}) {
        EXPECT_NEAR(at(4 + k, axis), 0.5 * (at(k, axis) + at((k + 1) % 4, axis)), 0.25 * size);
      }
    }
  }
}

}  // namespace
}  // namespace palp::fem
