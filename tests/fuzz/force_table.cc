// Input: a force-displacement table as CSV.
#include "patient_site/force_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/check.h"
#include "patient_site/tissue_field.h"
#include "tests/fuzz/fuzz.h"

namespace palp::patient {
namespace {

constexpr double kRounding = 1e-12;  // [1], of the larger neighbour

/// A cubic that is monotone from row to row lies between its rows.
void interval_laws(const ForceTable& table, const ForceRow& left, const ForceRow& right) {
  const auto [low, high] = std::minmax(left.force, right.force);
  const double slack = kRounding * high;
  for (const double share : {0.0, 1e-9, 0.1, 0.5, 0.9, 1 - 1e-9, 1.0}) {
    const double at = left.indentation + share * (right.indentation - left.indentation);
    const double force = table.force(at);
    PALP_CHECK(force >= low - slack && force <= high + slack, "between rows F lies between them");
    PALP_CHECK(std::isfinite(table.derivative(at)), "F has a slope everywhere");
  }
}

void table_laws(const ForceTable& table) {
  const auto rows = table.rows();
  PALP_CHECK(rows.size() >= 4 && rows.front().indentation == 0, "a table begins at the surface");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double force = table.force(rows[i].indentation);
    PALP_CHECK(std::abs(force - rows[i].force) <= kRounding * rows[i].force, "exact at the rows");
    if (i > 0) interval_laws(table, rows[i - 1], rows[i]);
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double outside : {-1e-9, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    PALP_CHECK(table.force(outside) == 0, "there is no force outside of the tissue");
  }
  for (const double beyond : {table.depth_max(), 2 * table.depth_max(), kInfinity}) {
    PALP_CHECK(table.force(beyond) == rows.back().force, "nothing is extrapolated");
  }
}

/// A tissue has a force everywhere, and at its places that of its curves.
void survey_laws(const std::vector<PlacedCurve>& curves) {
  for (const PlacedCurve& curve : curves) table_laws(curve.table);
  if (curves.size() < 2) return;
  const SurveyField field{curves, 0};
  for (const PlacedCurve& curve : curves) {
    const double depth = curve.table.depth_max() / 2;
    const double there = curve.table.force(depth);
    PALP_CHECK(std::abs(field.elastic_force(curve.place, depth) - there) <= 1e-9 * (1 + there),
               "a survey is its curves at their places");
    const Place beside{curve.place.x + 3e-4, curve.place.y - 7e-4};
    const double force = field.elastic_force(beside, depth);
    PALP_CHECK(std::isfinite(force) && force >= 0, "and has a force between them");
    PALP_CHECK(std::isfinite(field.stiffness(beside, depth)), "and a stiffness");
  }
}

}  // namespace
}  // namespace palp::patient

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto table = palp::patient::parse_force_table(palp::fuzz::as_text(data, size), "fuzz");
  if (table) {
    palp::patient::table_laws(*table);
  } else {
    PALP_CHECK(table.error().text.starts_with("fuzz: "), "a refusal says of what and why");
  }
  const auto curves =
      palp::patient::parse_tissue_curves(palp::fuzz::as_text(data, size), "fuzz", palp::kSiteB);
  if (curves) {
    palp::patient::survey_laws(*curves);
  } else {
    PALP_CHECK(curves.error().text.starts_with("fuzz: "), "a refusal says of what and why");
  }
  return 0;
}
