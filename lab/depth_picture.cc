#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/core/conventions.h"
#include "lab/depth_study.h"

namespace palp::lab {
namespace {

constexpr double kScale = 20;   // pixels a millimetre
constexpr double kMargin = 60;  // pixels
constexpr double kRange = 30;   // [mm]
constexpr double kSize = 2 * kMargin + kScale * kRange;
constexpr double kSpread = 1.8;  // [mm], to each side of a listed depth

struct Place {
  double x{};  ///< [mm], true depth
  double y{};  ///< [mm], estimate
};

class Picture {
 public:
  Picture() {
    char head[240];
    std::snprintf(head,
                  sizeof head,
                  "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
                  "font-family=\"sans-serif\" font-size=\"14\">\n"
                  "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                  kSize,
                  kSize);
    text_ = head;
  }
  void line(Place from, Place to, const char* colour, double width, double opacity) {
    char item[200];
    std::snprintf(item,
                  sizeof item,
                  "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" "
                  "stroke-width=\"%.1f\" stroke-opacity=\"%.2f\"/>\n",
                  x(from),
                  y(from),
                  x(to),
                  y(to),
                  colour,
                  width,
                  opacity);
    text_ += item;
  }
  void dot(Place at, const char* colour) {
    char item[120];
    std::snprintf(item,
                  sizeof item,
                  "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"1.8\" fill=\"%s\"/>\n",
                  x(at),
                  y(at),
                  colour);
    text_ += item;
  }
  void words(double at_x, double at_y, const char* anchor, const std::string& words) {
    char item[240];
    std::snprintf(item,
                  sizeof item,
                  "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n",
                  at_x,
                  at_y,
                  anchor,
                  words.c_str());
    text_ += item;
  }
  void axes() {
    for (int mm = 0; mm <= static_cast<int>(kRange); mm += 5) {
      const double at = mm;
      line({at, 0}, {at, kRange}, "#ddd", 1, 1);
      line({0, at}, {kRange, at}, "#ddd", 1, 1);
      words(x({at, 0}), y({at, 0}) + 20, "middle", std::to_string(mm));
      words(x({0, at}) - 8, y({0, at}) + 5, "end", std::to_string(mm));
    }
    words(kSize / 2, kSize - 12, "middle", "true depth of the inclusion's top, mm");
    char upright[160];
    std::snprintf(upright,
                  sizeof upright,
                  "<text transform=\"translate(18 %.0f) rotate(-90)\" text-anchor=\"middle\">"
                  "estimated depth, mm</text>\n",
                  kSize / 2);
    text_ += upright;
  }
  [[nodiscard]] std::string finish() { return std::move(text_) + "</svg>\n"; }

 private:
  static double x(Place at) { return kMargin + kScale * at.x; }
  static double y(Place at) { return kMargin + kScale * (kRange - at.y); }
  std::string text_;
};

}  // namespace

std::string depth_svg(const DepthStudy& study, const std::vector<DepthCase>& cases) {
  Picture picture;
  picture.axes();
  const bool random = study.depths.empty();
  picture.words(
      kMargin,
      22,
      "start",
      "Dots: estimated depth. Lines: 95 % intervals, red if they miss the truth (black).");
  picture.words(kMargin,
                42,
                "start",
                random ? "Faint: phantoms from a wider range than the estimator assumes."
                       : "Left of each depth the ball's size is known, right only a range.");
  if (random) picture.line({0, 0}, {kRange, kRange}, "black", 1, 1);
  for (const DepthCase& one : cases) {
    if (!one.inclusion || one.verdict != DepthVerdict::Found) continue;
    const bool inside = one.low <= one.depth && one.depth <= one.high;
    const char* colour = inside ? "steelblue" : "crimson";
    double at = one.depth / kMillimetre;
    if (!random) {
      // Palpations of one depth stand side by side.
      const double part = (one.index % study.repeats + 1.0) / (study.repeats + 1.0);
      at += (one.knowledge == Knowledge::Ball ? -1 : 1) * (0.1 + part * kSpread);
    }
    const double opacity = one.wide ? 0.15 : 0.45;
    picture.line({at, one.low / kMillimetre}, {at, one.high / kMillimetre}, colour, 1, opacity);
    picture.dot({at, one.estimate / kMillimetre}, colour);
  }
  for (const double depth : study.depths) {
    const double at = depth / kMillimetre;
    picture.line({at - kSpread, at}, {at + kSpread, at}, "black", 1, 1);
  }
  return picture.finish();
}

}  // namespace palp::lab
