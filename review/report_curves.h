#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "common/config/json.h"
#include "judge/excursions.h"
#include "judge/port_work.h"
#include "review/session_metrics.h"
#include "review/thinned.h"

namespace palp::review {

/// In its unit, rounded to what a screen shows.
[[nodiscard]] config::Json shown(double value, double unit);

/// What the page of a report draws of a session's ticks, in a bounded number of points however long
/// it was.
class ReportCurves final : public TickWatcher {
 public:
  void see(const judge::RunTick& tick) override;

  /// Of all ticks so far: curves over time, when the hand was not engaged, and the strokes.
  void add_to(config::Json& series) const;
  /// The ticks that those curves are drawn through, in order of time; not a number in between where
  /// there was none for long.
  [[nodiscard]] std::vector<judge::RunTick> ticks() const;

 private:
  /// A tick and the tissue's energy at it.
  struct Point {
    judge::RunTick tick;
    double energy_tissue{};  ///< [J]
  };
  /// Neighbouring ticks, as the two in which the hand was given least and most, so that no peak is
  /// lost between two points.
  struct Bucket {
    Point low;
    Point high;
  };
  struct Stroke {
    double at{};                        ///< [s]
    std::vector<judge::RunTick> ticks;  ///< some of them
  };

  void see_curve(const Point& point);
  void see_stroke(const judge::RunTick& tick);
  void see_idle(const judge::RunTick& tick);
  void end_stroke();
  [[nodiscard]] static Point nothing_at(double at);
  /// Of what is drawn, in order of time.
  [[nodiscard]] std::vector<Point> points() const;
  [[nodiscard]] bool went_in() const { return inside_ && stroke_max_ > judge::kStrokeDepthMin; }

  judge::PortWork tissue_;
  std::vector<Bucket> buckets_;
  std::size_t bucket_size_{1};                   ///< [ticks]
  std::size_t in_last_{};                        ///< [ticks]
  std::vector<std::pair<double, double>> idle_;  ///< [s]
  bool idle_now_{};
  double seen_at_{judge::kUndefined};  ///< [s], the newest tick
  bool inside_{};
  double stroke_at_{};   ///< [s]
  double stroke_max_{};  ///< [m]
  Thinned<judge::RunTick> stroke_{kLoopPoints};
  std::vector<Stroke> strokes_;

  static constexpr std::size_t kLoopPoints = 150;
};

}  // namespace palp::review
