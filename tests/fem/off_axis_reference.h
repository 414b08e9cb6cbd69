#pragma once

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fem/specimen.h"

/// What an independent three-dimensional code found: reference/off_axis/.
namespace palp::fem {

/// A row of a file.
struct Reference {
  double tilt{};         ///< [deg]
  double dome{};         ///< [mm]
  double offset{};       ///< [mm]
  double indentation{};  ///< [mm]
  double force{};        ///< [N]
  double plain{};        ///< [N]
};

inline std::vector<Reference> read_off_axis(const std::string& name) {
  std::ifstream in{std::string{PALP_TREE} + "/tests/fem/reference/off_axis/" + name + ".csv"};
  EXPECT_TRUE(in) << name;
  std::vector<Reference> out;
  std::string line;
  const bool finite = name.starts_with("neo");
  while (std::getline(in, line)) {
    Reference row;
    const std::string text = finite ? line : "0,0," + line;
    if (std::sscanf(text.c_str(),
                    "%lf,%lf,%lf,%lf,%lf,%lf",
                    &row.tilt,
                    &row.dome,
                    &row.offset,
                    &row.indentation,
                    &row.force,
                    &row.plain) == 6) {
      out.push_back(row);
    }
  }
  EXPECT_FALSE(out.empty()) << name;
  return out;
}

inline Specimen ball(double radius_mm, double depth_mm, double ratio) {
  Specimen specimen;
  specimen.inclusion = {.shape = InclusionShape::Ball,
                        .depth = depth_mm * 1e-3,
                        .radius = radius_mm * 1e-3,
                        .ratio = ratio};
  return specimen;
}

}  // namespace palp::fem
