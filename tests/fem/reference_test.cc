// Goal: the solver agrees with independent codes on every reference curve.
// Method: each file's header says what was solved; we solve it again and compare row by row.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fem/curve.h"

namespace palp::fem {
namespace {

struct Reference {
  CurveRequest request;
  std::vector<CurveRow> rows;
};

std::string value_of(const std::string& header, const std::string& key) {
  const auto at = header.find(' ' + key + '=');
  if (at == std::string::npos) return "";
  const auto begin = at + key.size() + 2;
  return header.substr(begin, header.find_first_of(" ;", begin) - begin);
}

Reference read(const std::string& path) {
  std::ifstream in{path};
  EXPECT_TRUE(in) << path;
  std::string header;
  std::string line;
  Reference out;
  while (std::getline(in, line)) {
    if (line.starts_with("#")) {
      header += ' ' + line;
      continue;
    }
    CurveRow row;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &row.indentation, &row.force, &row.error) != 3) {
      continue;
    }
    if (row.indentation <= 0) continue;
    row.indentation *= 1e-3;
    out.rows.push_back(row);
    out.request.indentations.push_back(row.indentation);
  }
  Specimen& specimen = out.request.specimen;
  specimen.block.poisson = header.find("nu=0.499") != std::string::npos ? 0.499 : 0.49;
  const bool linear = header.find("model=linear") != std::string::npos;
  out.request.model = linear ? Model::Linear : Model::NeoHookean;
  out.request.with_error = false;
  const std::string shape = value_of(header, "shape");
  if (shape != "none") {
    specimen.inclusion.shape = shape == "sphere" ? InclusionShape::Ball : InclusionShape::Column;
    specimen.inclusion.depth = 1e-3 * std::stod(value_of(header, "depth_mm"));
    specimen.inclusion.radius = 1e-3 * std::stod(value_of(header, "radius_mm"));
    specimen.inclusion.ratio = std::stod(value_of(header, "ratio"));
  }
  return out;
}

std::string path_of(const std::string& name) {
  const std::string phantom = std::string{PALP_TREE} + "/patient_site/phantoms/" + name + ".csv";
  if (std::ifstream{phantom}) return phantom;
  return std::string{PALP_TREE} + "/tests/fem/reference/" + name + ".csv";
}

class ReferenceTest : public testing::TestWithParam<const char*> {};

TEST_P(ReferenceTest, DefaultSettingsAgree) {
  const Reference reference = read(path_of(GetParam()));
  const auto curve = solve_curve(reference.request);
  ASSERT_TRUE(curve) << curve.error().text;
  const bool linear = reference.request.model == Model::Linear;
  const bool noisy = std::string{GetParam()}.starts_with("neoccx");
  for (std::size_t i = 0; i < reference.rows.size(); ++i) {
    const CurveRow& row = reference.rows[i];
    const bool shallow = row.indentation < 0.5e-3 - 1e-9;
    const bool deep = row.indentation > 4e-3 + 1e-9;
    if (!linear && (shallow || deep)) continue;
    const double limit = linear ? (shallow ? 0.01 : 0.003) : noisy ? 0.012 : 0.006;
    EXPECT_NEAR(curve->rows[i].force / row.force, 1, limit) << "d " << row.indentation;
  }
}

/// The files of the linear model, whose own error is small enough for it.
class LinearReferenceTest : public ReferenceTest {};

TEST_P(LinearReferenceTest, FineSettingsAgreeWithinTheFilesOwnError) {
  Reference reference = read(path_of(GetParam()));
  reference.request.accuracy = Accuracy::Fine;
  const auto curve = solve_curve(reference.request);
  ASSERT_TRUE(curve) << curve.error().text;
  for (std::size_t i = 0; i < reference.rows.size(); ++i) {
    const CurveRow& row = reference.rows[i];
    const double limit = std::max(1e-3 * row.force, 2 * row.error);
    EXPECT_NEAR(curve->rows[i].force, row.force, limit) << "d " << row.indentation;
  }
}

std::string name_of(const testing::TestParamInfo<const char*>& file) { return file.param; }

const auto kLinearFiles = testing::Values("lin_column_r2p7_d5",
                                          "lin_column_r2p7_d10",
                                          "lin_column_r2p7_d15",
                                          "lin_column_r2p7_d20",
                                          "lin_column_r2p7_d25",
                                          "lin_homog",
                                          "lin_homog_nu0p499",
                                          "lin_sphere_r15_d5_k856",
                                          "lin_sphere_r15_d10_k856",
                                          "lin_sphere_r15_d15_k856",
                                          "lin_sphere_r15_d20_k856",
                                          "lin_sphere_r15_d25_k856",
                                          "lin_sphere_r3_d5_k856",
                                          "lin_sphere_r5_d5_k5",
                                          "lin_sphere_r5_d5_k856",
                                          "lin_sphere_r5_d10_k50",
                                          "lin_sphere_r5_d10_k856",
                                          "lin_sphere_r5_d15_k856",
                                          "lin_sphere_r5_d20_k856",
                                          "lin_sphere_r5_d25_k856",
                                          "lin_sphere_r7p5_d5_k50",
                                          "lin_sphere_r7p5_d10_k856");
const auto kFiniteFiles = testing::Values("neo_column_r2p7_d5",
                                          "neo_column_r2p7_d10",
                                          "neo_homog",
                                          "neo_sphere_r15_d5_k856",
                                          "neo_sphere_r15_d10_k856",
                                          "neo_sphere_r15_d15_k856",
                                          "neo_sphere_r15_d20_k856",
                                          "neo_sphere_r15_d25_k856",
                                          "neoccx_sphere_r15_d10");

INSTANTIATE_TEST_SUITE_P(Linear, ReferenceTest, kLinearFiles, name_of);
INSTANTIATE_TEST_SUITE_P(Finite, ReferenceTest, kFiniteFiles, name_of);
INSTANTIATE_TEST_SUITE_P(Linear, LinearReferenceTest, kLinearFiles, name_of);

}  // namespace
}  // namespace palp::fem
