#include "study/level_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/config/number.h"
#include "study/stimulus.h"

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

/// A level, and how deep the ball lies that means it.
struct LevelDepth {
  double level{};  // [-]
  double depth{};  // [m]
};

std::vector<LevelDepth> depths_of(const Study& study) {
  std::vector<LevelDepth> out;
  if (!study.task.ranks) {
    for (const BallDepth& one : study.depths) out.push_back({one.contrast, one.depth});
    return out;
  }
  const BallDepth& deepest = study.depths.front();
  const BallDepth& least = study.depths.back();
  for (const double level : tissue_levels(study)) {
    const double contrast =
        std::clamp(middle_contrast(study) + level, deepest.contrast, least.contrast);
    out.push_back({level, *depth_of(study, contrast)});
  }
  return out;
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
  for (const LevelDepth& one : depths_of(study)) {
    auto phantom = ball_phantom(study.ball->radius, study.ball->ratio, one.depth);
    if (!phantom) return tl::unexpected(phantom.error());
    curves.plain_ = extended(phantom->plain, kDeep);
    ForceTable above = extended(phantom->over, kDeep);
    curves.balls_.push_back({one.level, std::move(above), std::move(*phantom)});
  }
  curves.has_plain_ = !study.task.ranks;
  return curves;
}

const LevelCurves::BallCurve& LevelCurves::nearest(double level) const {
  return *std::ranges::min_element(
      balls_, {}, [level](const BallCurve& one) { return std::abs(one.level - level); });
}

ForceTable LevelCurves::at(double level) const {
  if (level == 0 && has_plain_) return plain_;
  return balls_.empty() ? scaled(plain_, level) : nearest(level).table;
}

patient::Phantom LevelCurves::hiding(double level, const Place& axis) const {
  patient::Phantom out = nearest(level).phantom;
  out.axis = axis;
  out.block->inclusions.front().axis = axis;
  return out;
}

}  // namespace palp::study
