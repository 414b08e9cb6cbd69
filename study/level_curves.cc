#include "study/level_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/config/number.h"

namespace palp::study {
namespace {

using config::number_text;
using patient::ForceRow;
using patient::ForceTable;

ForceTable scaled(const ForceTable& table, double ln_factor) {
  std::vector<ForceRow> rows{table.rows().begin(), table.rows().end()};
  for (ForceRow& row : rows) row.force *= std::exp(ln_factor);
  return ForceTable::make(std::move(rows)).value();
}

/// To `depth` [m]: where a curve was not solved so far it goes on as steeply as it ended.
ForceTable extended(const ForceTable& table, double depth) {
  constexpr double kStep = 0.1e-3;  // [m], of the slope at the end, and the least worth adding
  std::vector<ForceRow> rows{table.rows().begin(), table.rows().end()};
  const ForceRow last = rows.back();
  if (depth < last.indentation + kStep) return table;
  const double slope = (last.force - table.force(last.indentation - kStep)) / kStep;
  rows.push_back({depth, last.force + slope * (depth - last.indentation)});
  return ForceTable::make(std::move(rows)).value();
}

}  // namespace

Result<patient::Phantom> ball_phantom(double radius, double ratio, double depth) {
  return patient::make_phantom("ball depth=" + number_text(depth * 1e3) +
                               " radius=" + number_text(radius * 1e3) +
                               " ratio=" + number_text(ratio) + " at=20,0");
}

LevelCurves::LevelCurves() : plain_{patient::make_phantom("none").value().plain} {}

Result<LevelCurves> LevelCurves::make(const Study& study) {
  constexpr double kDeep = 8e-3;  // [m], beyond what hands press
  LevelCurves curves;
  if (!study.ball) return curves;
  for (const BallDepth& one : study.depths) {
    const auto phantom = ball_phantom(study.ball->radius, study.ball->ratio, one.depth);
    if (!phantom) return tl::unexpected(phantom.error());
    curves.plain_ = extended(phantom->plain, kDeep);
    curves.balls_.push_back({one.contrast, extended(phantom->over, kDeep)});
  }
  return curves;
}

ForceTable LevelCurves::at(double level) const {
  if (level == 0) return plain_;
  if (balls_.empty()) return scaled(plain_, level);
  return std::ranges::min_element(
             balls_, {}, [level](const BallCurve& one) { return std::abs(one.level - level); })
      ->table;
}

}  // namespace palp::study
