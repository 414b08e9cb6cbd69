#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/core/conventions.h"
#include "lab/plan/depth_study.h"

namespace palp::lab {
namespace {

constexpr double kScale = 20;   // pixels a millimetre
constexpr double kMargin = 60;  // pixels
constexpr double kRange = 30;   // [mm]
constexpr double kSize = 2 * kMargin + kScale * kRange;
constexpr double kSpread = 1.8;      // [mm], to each side of a listed depth
constexpr std::size_t kDrawn = 300;  // random phantoms; more hide each other
constexpr double kBin = 3;           // [mm], of true depth, in which held intervals are counted
constexpr double kFirstBin = 1;      // [mm]; so that the prior's 4 to 25 mm are whole bins
constexpr double kShares = 240;      // pixels, height of the picture below: 50 to 100 %

struct Place {
  double x{};  ///< [mm], true depth
  double y{};  ///< [mm], estimate
};

class Picture {
 public:
  explicit Picture(double height) {
    char head[240];
    std::snprintf(head,
                  sizeof head,
                  "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
                  "font-family=\"sans-serif\" font-size=\"14\">\n"
                  "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                  kSize,
                  height);
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
  /// Below: a share [-] over the true depth, with the error of counting so many.
  void share(double depth, double share, std::size_t count) {
    const double at = x({depth, 0});
    const double error = std::sqrt(share * (1 - share) / static_cast<double>(count));
    pixels(at, share_y(share - error), at, share_y(std::min(1.0, share + error)), "steelblue");
    char item[120];
    std::snprintf(item,
                  sizeof item,
                  "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"steelblue\"/>\n",
                  at,
                  share_y(share));
    text_ += item;
  }
  void share_axes() {
    for (const int percent : {50, 60, 70, 80, 90, 95, 100}) {
      const double at = share_y(percent / 100.0);
      pixels(x({0, 0}), at, x({kRange, 0}), at, percent == 95 ? "black" : "#ddd");
      words(x({0, 0}) - 8, at + 5, "end", std::to_string(percent) + " %");
    }
    for (int mm = 0; mm <= static_cast<int>(kRange); mm += 5) {
      words(x({1.0 * mm, 0}), share_y(0.5) + 20, "middle", std::to_string(mm));
    }
    words(kSize / 2, share_y(0.5) + 42, "middle", "true depth of the inclusion's top, mm");
  }
  [[nodiscard]] std::string finish() { return std::move(text_) + "</svg>\n"; }

 private:
  static double x(Place at) { return kMargin + kScale * at.x; }
  static double y(Place at) { return kMargin + kScale * (kRange - at.y); }
  static double share_y(double share) {
    return kSize + 30 + kShares * (1 - std::max(share, 0.5)) / 0.5;
  }
  void pixels(double x1, double y1, double x2, double y2, const char* colour) {
    char item[160];
    std::snprintf(item,
                  sizeof item,
                  "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n",
                  x1,
                  y1,
                  x2,
                  y2,
                  colour);
    text_ += item;
  }
  std::string text_;
};

bool held(const DepthCase& one) { return one.low <= one.depth && one.depth <= one.high; }

/// Share of the intervals that hold the truth, over the depth, of phantoms drawn from the prior.
void draw_shares(Picture& picture, const std::vector<DepthCase>& cases) {
  picture.words(kMargin,
                kSize + 18,
                "start",
                "Share of the intervals that hold the truth; bars: the error of counting so many.");
  picture.share_axes();
  for (int bin = 0; kFirstBin + bin * kBin < kRange; ++bin) {
    const double from = kFirstBin + bin * kBin;
    std::size_t count = 0;
    std::size_t inside = 0;
    for (const DepthCase& one : cases) {
      const double depth = one.depth / kMillimetre;
      if (!one.inclusion || one.wide || one.verdict != DepthVerdict::Found) continue;
      if (depth < from || depth >= from + kBin) continue;
      ++count;
      if (held(one)) ++inside;
    }
    if (count == 0) continue;
    picture.share(from + kBin / 2, static_cast<double>(inside) / static_cast<double>(count), count);
  }
}

}  // namespace

std::string depth_svg(const DepthStudy& study, const std::vector<DepthCase>& cases) {
  const bool random = study.depths.empty();
  Picture picture{random ? kSize + kShares + 100 : kSize};
  picture.axes();
  std::vector<const DepthCase*> found;
  for (const DepthCase& one : cases) {
    if (one.inclusion && one.verdict == DepthVerdict::Found) found.push_back(&one);
  }
  const std::size_t stride = random ? 1 + found.size() / kDrawn : 1;
  picture.words(
      kMargin,
      22,
      "start",
      "Dots: estimated depth. Lines: 95 % intervals, red if they miss the truth (black).");
  std::string second = "Left of each depth the ball's size is known, right only a range.";
  if (random) {
    second = "Faint: phantoms from a wider range than the estimator assumes.";
    if (stride > 1) second += " One of " + std::to_string(stride) + " is drawn.";
  }
  picture.words(kMargin, 42, "start", second);
  for (std::size_t i = 0; i < found.size(); i += stride) {
    const DepthCase& one = *found[i];
    const char* colour = held(one) ? "steelblue" : "crimson";
    double at = one.depth / kMillimetre;
    if (!random) {
      // Palpations of one depth stand side by side.
      const double part = (one.index % study.repeats + 1.0) / (study.repeats + 1.0);
      at += (one.knowledge == Knowledge::Ball ? -1 : 1) * (0.1 + part * kSpread);
    }
    const double opacity = one.wide ? 0.2 : 0.6;
    picture.line({at, one.low / kMillimetre}, {at, one.high / kMillimetre}, colour, 1, opacity);
    picture.dot({at, one.estimate / kMillimetre}, colour);
  }
  for (const double depth : study.depths) {
    const double at = depth / kMillimetre;
    picture.line({at - kSpread, at}, {at + kSpread, at}, "black", 2, 1);
  }
  if (random) {
    picture.line({0, 0}, {kRange, kRange}, "black", 2, 1);
    draw_shares(picture, cases);
  }
  return picture.finish();
}

}  // namespace palp::lab
