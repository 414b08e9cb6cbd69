#include "fem/interpolation_check.h"

#include <algorithm>
#include <cmath>

#include "common/core/random.h"
#include "depth/depth_database.h"
#include "fem/database_builder.h"

namespace palp::fem {
namespace {

constexpr std::uint64_t kCheckStream = 7;  // of the random numbers

}  // namespace

Result<void> check_interpolation(DepthTable& table,
                                 std::uint32_t count,
                                 std::uint64_t seed,
                                 Accuracy mesh) {
  const auto database = depth::DepthDatabase::make(table);
  if (!database) return tl::unexpected<Error>(database.error());
  const DepthGrid& grid = table.grid;
  const depth::DepthDatabase::Curve plain = database->plain();
  std::uint64_t draw = 0;
  const auto between = [&](const std::vector<double>& axis) {
    const double share = random_uniform(seed, kCheckStream, draw++);
    return axis.front() * std::pow(axis.back() / axis.front(), share);
  };
  double sum = 0;
  double most = 0;
  std::size_t points = 0;
  for (std::uint32_t done = 0; done < count;) {
    const bool ball = random_uniform(seed, kCheckStream, draw++) < 0.5;
    const depth::DepthDatabase::Query query{
        .shape = ball ? InclusionShape::Ball : InclusionShape::Cylinder,
        .depth = between(grid.depths),
        .radius = between(grid.radii),
        .ratio = between(grid.ratios)};
    if (!database->contains(query)) continue;
    ++done;
    DepthGrid single = grid;
    single.depths = {query.depth};
    single.radii = {query.radius};
    single.ratios = {query.ratio};
    const auto solved = solve_cell(single, {query.shape, 0, 0}, mesh);
    const depth::DepthDatabase::Curve curve = database->curve(query);
    const std::vector<float>& excess = solved.at(0).excess;
    for (std::size_t i = 0; i < excess.size(); ++i) {
      const double d = grid.indentations[i];
      if (d > curve.indentation_max) break;
      const double wanted = 1 + static_cast<double>(excess[i]);
      const double found = database->force(curve, d) / database->force(plain, d);
      sum += (found / wanted - 1) * (found / wanted - 1);
      most = std::max(most, std::abs(found / wanted - 1));
      ++points;
    }
  }
  table.checked_count = count;
  table.checked_rms = points > 0 ? std::sqrt(sum / static_cast<double>(points)) : 0;
  table.checked_max = most;
  return {};
}

}  // namespace palp::fem
