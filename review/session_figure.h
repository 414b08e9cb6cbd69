#pragma once

#include <limits>

#include "common/plot/figure.h"
#include "review/report_curves.h"

namespace palp::review {

/// From `from` to `to`, as the ticks count their time.
struct FigureSpan {
  double from{-std::numeric_limits<double>::infinity()};  ///< [s]
  double to{std::numeric_limits<double>::infinity()};     ///< [s]
};

/// Hand and tip over time as a figure: where both were, what was felt and what was touched. Of any
/// session, in a bounded number of points.
class SessionFigure final : public TickWatcher {
 public:
  explicit SessionFigure(const FigureSpan& span) : span_{span} {}
  void see(const judge::RunTick& tick) override;

  /// Of what it saw within its span; nothing: no panels.
  [[nodiscard]] plot::Figure figure() const;

 private:
  FigureSpan span_;
  ReportCurves curves_;
};

}  // namespace palp::review
