#include "review/report_curves.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace palp::review {
namespace {

using config::Json;

constexpr std::size_t kBucketsMax = 6000;
constexpr std::size_t kIdleMax = 2000;
constexpr std::size_t kLoopsMax = 60;
constexpr double kGapMin = 0.05;  ///< [s], longer than a site stands still

}  // namespace

Json shown(double value, double unit) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value / unit * 1e4) * 1e-4;
}

/// No line leads through time that nobody wrote down.
ReportCurves::Point ReportCurves::nothing_at(double at) {
  Point point;
  point.tick.at = at;
  for (double* value : {&point.tick.hand,
                        &point.tick.hand_force,
                        &point.tick.force_true,
                        &point.tick.contact_force,
                        &point.tick.tip,
                        &point.tick.tip_place.x,
                        &point.tick.tip_place.y,
                        &point.tick.energy_operator,
                        &point.energy_tissue}) {
    *value = judge::kUndefined;
  }
  return point;
}

void ReportCurves::see(const judge::RunTick& tick) {
  if (std::isfinite(tick.tip)) tissue_.add_reading(tick.tip, tick.contact_force);
  see_curve({tick, tissue_.work()});
  see_idle(tick);
  see_stroke(tick);
}

void ReportCurves::see_curve(const Point& point) {
  const auto join = [](Bucket& to, const Bucket& from) {
    if (from.low.tick.hand_force < to.low.tick.hand_force) to.low = from.low;
    if (from.high.tick.hand_force > to.high.tick.hand_force) to.high = from.high;
  };
  if (!buckets_.empty() && in_last_ < bucket_size_) {
    join(buckets_.back(), {point, point});
    ++in_last_;
    return;
  }
  if (buckets_.size() == kBucketsMax) {
    for (std::size_t i = 0; i < kBucketsMax / 2; ++i) {
      buckets_[i] = buckets_[2 * i];
      join(buckets_[i], buckets_[2 * i + 1]);
    }
    buckets_.resize(kBucketsMax / 2);
    bucket_size_ *= 2;
  }
  buckets_.push_back({point, point});
  in_last_ = 1;
}

void ReportCurves::see_idle(const judge::RunTick& tick) {
  const double before = std::exchange(seen_at_, tick.at);
  if (tick.at - before > kGapMin && idle_.size() < kIdleMax) idle_.emplace_back(before, tick.at);
  if (tick.counted) {
    idle_now_ = false;
    return;
  }
  if (!idle_now_) {
    if (idle_.size() == kIdleMax) return;
    idle_.emplace_back(tick.at, tick.at);
    idle_now_ = true;
  }
  idle_.back().second = tick.at;
}

void ReportCurves::see_stroke(const judge::RunTick& tick) {
  if (!(tick.hand > 0 && tick.counted)) {
    end_stroke();
    return;
  }
  if (strokes_.size() >= kLoopsMax) return;
  if (!inside_) {
    inside_ = true;
    stroke_at_ = tick.at;
    stroke_max_ = tick.hand;
  }
  stroke_max_ = std::max(stroke_max_, tick.hand);
  stroke_.add(tick);
}

void ReportCurves::end_stroke() {
  if (went_in()) strokes_.push_back({stroke_at_, stroke_.take()});
  if (!inside_) return;
  inside_ = false;
  stroke_ = Thinned<judge::RunTick>{kLoopPoints};
}

std::vector<ReportCurves::Point> ReportCurves::points() const {
  std::vector<Point> points;
  const double gap = kGapMin + 2e-3 * static_cast<double>(bucket_size_);
  const auto add = [&](const Point& point) {
    const double last = points.empty() ? point.tick.at : points.back().tick.at;
    if (point.tick.at - last > gap) points.push_back(nothing_at(0.5 * (last + point.tick.at)));
    points.push_back(point);
  };
  for (const Bucket& bucket : buckets_) {
    const bool falls = bucket.high.tick.at < bucket.low.tick.at;
    add(falls ? bucket.high : bucket.low);
    if (bucket.high.tick.at != bucket.low.tick.at) add(falls ? bucket.low : bucket.high);
  }
  return points;
}

std::vector<judge::RunTick> ReportCurves::ticks() const {
  std::vector<judge::RunTick> ticks;
  for (const Point& point : points()) ticks.push_back(point.tick);
  return ticks;
}

void ReportCurves::add_to(Json& series) const {
  for (const char* name :
       {"t", "felt", "touched", "truth", "hand", "tip", "x", "y", "energy", "energy_tissue"}) {
    series[name] = Json::array();
  }
  const auto draw = [&](const Point& point) {
    const judge::RunTick& tick = point.tick;
    series["t"].push_back(shown(tick.at, 1));
    series["felt"].push_back(shown(tick.hand_force, 1));
    series["touched"].push_back(shown(tick.contact_force, 1));
    series["truth"].push_back(shown(tick.force_true, 1));
    series["hand"].push_back(shown(tick.hand, 1e-3));
    series["tip"].push_back(shown(tick.tip, 1e-3));
    series["x"].push_back(shown(tick.tip_place.x, 1e-3));
    series["y"].push_back(shown(tick.tip_place.y, 1e-3));
    series["energy"].push_back(shown(tick.energy_operator, 1e-3));
    series["energy_tissue"].push_back(shown(point.energy_tissue, 1e-3));
  };
  for (const Point& point : points()) draw(point);
  series["idle"] = Json::array();
  for (const auto& [from, to] : idle_) series["idle"].push_back({from, to});
  series["loops"] = Json::array();
  std::size_t count = 0;
  const auto add_loop = [&](double at, const std::vector<judge::RunTick>& ticks) {
    Json loop{{"name", "stroke " + std::to_string(++count)}, {"at", at}};
    for (const char* name : {"d", "felt", "truth"}) loop[name] = Json::array();
    for (const judge::RunTick& tick : ticks) {
      loop["d"].push_back(shown(tick.hand, 1e-3));
      loop["felt"].push_back(shown(tick.hand_force, 1));
      loop["truth"].push_back(shown(tick.force_true, 1));
    }
    series["loops"].push_back(loop);
  };
  for (const Stroke& stroke : strokes_) add_loop(stroke.at, stroke.ticks);
  if (went_in()) add_loop(stroke_at_, stroke_.kept());
}

}  // namespace palp::review
