#include "lab/report/depth_picture.h"

#include <algorithm>
#include <cmath>

#include "common/core/conventions.h"

namespace palp::lab {
namespace {

constexpr double kRange = 30;                // [mm]
constexpr double kSpread = 1.8;              // [mm], to each side of a listed depth
constexpr std::size_t kPhantomsDrawn = 300;  // random phantoms; more hide each other
constexpr double kBin = 3;               // [mm], of true depth, in which held intervals are counted
constexpr double kFirstBin = 1;          // [mm]; so that the prior's 4 to 25 mm are whole bins
constexpr double kPromise = 0.95;        // [-], of the intervals
constexpr double kFaint = 0.3;           // [-], opacity
constexpr double kPhantomOpacity = 0.7;  // [-]
constexpr const char* kDepthAxis = "true depth of the inclusion's top [mm]";

bool holds_truth(const DepthCase& one) { return one.low <= one.depth && one.depth <= one.high; }

void add(plot::Curve& curve, double at, const DepthCase& one) {
  curve.x.push_back(at);
  curve.y.push_back(one.estimate / kMillimetre);
  curve.low.push_back(one.low / kMillimetre);
  curve.high.push_back(one.high / kMillimetre);
}

/// Cases by whether they hold the truth, those of a wider range than the estimator assumes apart.
std::vector<plot::Curve> four_kinds(bool random) {
  const auto kind = [](const char* name, int colour, double opacity) {
    return plot::Curve{
        .name = name, .mark = plot::Mark::Intervals, .colour = colour, .opacity = opacity};
  };
  return {kind("95 % interval", plot::kBlue, kPhantomOpacity),
          kind("interval that misses the truth", plot::kVermilion, kPhantomOpacity),
          kind(random ? "ball of a wider range than assumed" : "", plot::kBlue, kFaint),
          kind("", plot::kVermilion, kFaint)};
}

plot::Panel estimates_panel(const DepthStudy& study, const std::vector<DepthCase>& cases) {
  const bool random = study.depths.empty();
  plot::Panel panel{.axes = {.x_name = kDepthAxis,
                             .y_name = "estimated depth [mm]",
                             .y_from = 0,
                             .y_to = kRange,
                             .height = 1.6},
                    .curves = four_kinds(random)};
  std::vector<const DepthCase*> found;
  for (const DepthCase& one : cases) {
    if (one.inclusion && one.verdict == DepthVerdict::Found) found.push_back(&one);
  }
  const std::size_t stride = random ? 1 + found.size() / kPhantomsDrawn : 1;
  if (!random)
    panel.axes.title = "Left of each depth the ball's size is known, right only a range.";
  if (stride > 1) panel.axes.title = "One of " + std::to_string(stride) + " is drawn.";
  for (std::size_t i = 0; i < found.size(); i += stride) {
    const DepthCase& one = *found[i];
    double at = one.depth / kMillimetre;
    if (!random) {
      // Palpations of one depth stand side by side.
      const double part = (one.index % study.repeats + 1.0) / (study.repeats + 1.0);
      at += (one.knowledge == Knowledge::Ball ? -1 : 1) * (0.1 + part * kSpread);
    }
    const std::size_t kind = (holds_truth(one) ? 0U : 1U) + (random && one.wide ? 2U : 0U);
    add(panel.curves[kind], at, one);
  }
  plot::Curve truth{.name = "truth", .colour = plot::kBlack};
  for (const double depth : study.depths) {
    const double at = depth / kMillimetre;
    truth.x.insert(truth.x.end(), {at - kSpread, at + kSpread, at + kSpread});
    truth.y.insert(truth.y.end(), {at, at, NAN});
  }
  if (random) {
    truth.x = {0, kRange};
    truth.y = {0, kRange};
  }
  panel.curves.push_back(std::move(truth));
  std::erase_if(panel.curves, [](const plot::Curve& curve) { return curve.x.empty(); });
  return panel;
}

/// Of phantoms drawn from the prior.
plot::Panel shares_panel(const std::vector<DepthCase>& cases) {
  plot::Curve shares{.name = "intervals that hold the truth",
                     .mark = plot::Mark::Intervals,
                     .colour = plot::kBlue};
  for (int bin = 0; kFirstBin + bin * kBin < kRange; ++bin) {
    const double from = kFirstBin + bin * kBin;
    double count = 0;
    double inside = 0;
    for (const DepthCase& one : cases) {
      const double depth = one.depth / kMillimetre;
      if (!one.inclusion || one.wide || one.verdict != DepthVerdict::Found) continue;
      if (depth < from || depth >= from + kBin) continue;
      ++count;
      if (holds_truth(one)) ++inside;
    }
    if (count == 0) continue;
    const double share = inside / count;
    const double error = std::sqrt(share * (1 - share) / count);
    shares.x.push_back(from + kBin / 2);
    shares.y.push_back(100 * share);
    shares.low.push_back(100 * (share - error));
    shares.high.push_back(100 * std::min(1.0, share + error));
  }
  const plot::Curve promised{.name = "promised",
                             .x = {0, kRange},
                             .y = {100 * kPromise, 100 * kPromise},
                             .mark = plot::Mark::Dashes,
                             .colour = plot::kBlack};
  return {.axes = {.x_name = kDepthAxis, .y_name = "share [%]", .y_from = 50, .y_to = 100},
          .curves = {shares, promised}};
}

}  // namespace

plot::Figure depth_figure(const DepthStudy& study, const std::vector<DepthCase>& cases) {
  plot::Figure figure{.title = "Depth estimates", .panels = {estimates_panel(study, cases)}};
  if (study.depths.empty()) {
    figure.panels.front().axes.x_name.clear();  // both panels have one
    figure.panels.push_back(shares_panel(cases));
  }
  return figure;
}

}  // namespace palp::lab
