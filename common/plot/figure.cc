#include "common/plot/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/plot/outline.h"
#include "common/plot/svg_text.h"
#include "common/plot/ticks.h"

namespace palp::plot {
namespace {

// Okabe and Ito's colours, and grey.
constexpr std::array kColours{
    "#0072b2", "#e69f00", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#000000", "#aaaaaa"};
constexpr std::size_t kTicksMax = 14;
// In sizes of the letters:
constexpr double kLegendRow = 1.5;
constexpr double kLegendSample = 2;  // the piece of line before a name
constexpr double kLegendGap = 1.5;
constexpr double kCellHeight = 1.7;
constexpr double kNameRow = 1.25;
constexpr double kRightMargin = 1.5;  // half of a number may stand beyond the axis
constexpr double kPointSize = 0.28;
constexpr double kTickGap = 0.7;   // between two numbers
constexpr double kPadding = 0.03;  // [-], of the axis, so that nothing lies on its end

struct Range {
  double from{std::numeric_limits<double>::infinity()};  ///< [as the axis]
  double to{-std::numeric_limits<double>::infinity()};   ///< [as the axis]
  void add(double value) {
    if (!std::isfinite(value)) return;
    from = std::min(from, value);
    to = std::max(to, value);
  }
  [[nodiscard]] double share(double value) const {
    return to > from ? (value - from) / (to - from) : 0.5;
  }
};

/// By a share of it at each end; a range that is one point by a half.
void widen(Range& range, double share) {
  const double more = range.to > range.from ? share * (range.to - range.from) : 0.5;
  range = {range.from - more, range.to + more};
}

/// About `count` round places. [as the axis]
std::vector<double> ticks_within(const Range& range, int count) {
  const double slack = 1e-9 * (range.to - range.from);
  std::vector<double> ticks = round_ticks(range.from, range.to, count);
  std::erase_if(ticks,
                [&](double tick) { return tick < range.from - slack || tick > range.to + slack; });
  return ticks;
}

Range classes(const std::vector<std::string>& names) {
  return {-0.5, static_cast<double>(names.size()) - 0.5};
}

/// Draws one panel.
class PanelWriter {
 public:
  PanelWriter(const Panel& panel, const Style& style)
      : axes_{panel.axes}, curves_{panel.curves}, style_{style}, em_{style.text} {
    bool points = false;
    for (const Curve& curve : curves_) {
      points = points || curve.mark == Mark::Points || curve.mark == Mark::Intervals;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (!std::isfinite(curve.y[i])) continue;
        across_.add(place(curve.x[i]));
        up_.add(curve.y[i]);
        if (curve.mark != Mark::Intervals) continue;
        up_.add(curve.low[i]);
        up_.add(curve.high[i]);
      }
    }
    set_up();
    set_across(points);
  }

  /// [pt], what stands left of the axis.
  [[nodiscard]] double left_needed() const {
    double widest = 0;
    for (const double y : y_ticks_) widest = std::max(widest, width_of(tick_text(y), em_));
    for (const auto& name : axes_.y_classes) widest = std::max(widest, width_of(name, em_));
    return widest + (1.2 + kNameRow * static_cast<double>(y_name().size())) * em_;
  }

  /// @returns [pt], where the next panel may begin.
  double write(std::string& text, double left, double top) {
    left_ = left;
    right_ = style_.width - kRightMargin * em_;
    top_ = top;
    if (!axes_.title.empty()) label(text, left_, top_ += 1.2 * em_, "start", axes_.title);
    write_legend(text);
    top_ += 0.7 * em_;
    low_ = top_ + height();
    write_grid(text);
    for (std::size_t c = 0; c < curves_.size(); ++c) write_curve(text, curves_[c], colour_of(c));
    write_numbers(text);
    return low_ + (axes_.x_name.empty() ? 0.6 : 3.4) * em_;
  }

 private:
  /// [pt], of the axes.
  [[nodiscard]] double height() const {
    if (axes_.y_classes.empty()) return axes_.height * style_.panel_height;
    return kCellHeight * em_ * static_cast<double>(axes_.y_classes.size());
  }
  /// In two rows where the axis is too short for one.
  [[nodiscard]] std::vector<std::string> y_name() const {
    const std::string& name = axes_.y_name;
    if (name.empty()) return {};
    if (width_of(name, em_) <= height()) return {name};
    std::size_t cut = name.size();
    for (std::size_t at = name.find(' '); at != std::string::npos; at = name.find(' ', at + 1)) {
      const auto from_middle = [&](std::size_t i) { return std::max(i, name.size() - i); };
      if (from_middle(at) < from_middle(cut)) cut = at;
    }
    if (cut == name.size()) return {name};
    return {name.substr(0, cut), name.substr(cut + 1)};
  }

  void set_up() {
    if (!axes_.y_classes.empty()) {
      up_ = classes(axes_.y_classes);
      std::swap(up_.from, up_.to);  // the first on top
      return;
    }
    if (!(up_.from <= up_.to)) up_ = {0, 1};
    widen(up_, kPadding);
    if (axes_.y_to > axes_.y_from) up_ = {axes_.y_from, axes_.y_to};
    y_ticks_ = ticks_within(up_, std::max(3, static_cast<int>(height_in_numbers())));
  }
  /// How many numbers stand well beside the axis.
  [[nodiscard]] double height_in_numbers() const { return std::min(7.0, height() / (3.2 * em_)); }

  void set_across(bool points) {
    if (!axes_.x_classes.empty()) {
      across_ = classes(axes_.x_classes);
      return;
    }
    if (!(across_.from <= across_.to)) across_ = {0, 1};
    const Range data = across_;
    widen(across_, points ? kPadding : 0);
    if (!axes_.x_logarithmic) {
      x_ticks_ = ticks_within(across_, static_cast<int>(std::min(8.0, style_.width / (6 * em_))));
      return;
    }
    const double from = std::pow(10, data.from);
    const double to = std::pow(10, data.to);
    const auto own = curves_.empty() ? std::vector<double>{} : curves_.front().x;
    for (const auto& ticks : {own, decade_ticks(from, to), power_ticks(from, to)}) {
      if (ticks.empty() || ticks.size() > kTicksMax || crowded(ticks)) continue;
      x_ticks_ = ticks;
      return;
    }
    x_ticks_ = {from, to};
  }

  /// Whether numbers below the axis would run into each other.
  [[nodiscard]] bool crowded(std::vector<double> ticks) const {
    const double width = style_.width - 8 * em_;  // about that of the axis
    std::sort(ticks.begin(), ticks.end());
    ticks.erase(std::unique(ticks.begin(), ticks.end()), ticks.end());
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      const double apart =
          width * (across_.share(place(ticks[i])) - across_.share(place(ticks[i - 1])));
      const double halves =
          0.5 * (width_of(tick_text(ticks[i]), em_) + width_of(tick_text(ticks[i - 1]), em_));
      if (apart < halves + kTickGap * em_) return true;
    }
    return false;
  }
  // A round trip of 0 has no logarithm; below 1 nothing differs.
  [[nodiscard]] double place(double x) const {
    return axes_.x_logarithmic ? std::log10(std::max(x, 1.0)) : x;
  }
  [[nodiscard]] double x_of(double x) const {
    return left_ + (right_ - left_) * across_.share(place(x));
  }
  [[nodiscard]] double y_of(double y) const {
    const double share = (y - up_.from) / (up_.to - up_.from);
    return low_ - (low_ - top_) * std::clamp(share, 0.0, 1.0);
  }
  [[nodiscard]] const char* colour_of(std::size_t curve) const {
    const int asked = curves_[curve].colour;
    return kColours[asked >= 0 ? static_cast<std::size_t>(asked) % kColours.size()
                               : curve % kCurveColours];
  }

  static void write_line(std::string& text, Spot from, Spot to, const char* look) {
    append(text,
           "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n",
           from.x,
           from.y,
           to.x,
           to.y,
           look);
  }

  void write_grid(std::string& text) const {
    for (const double y : y_ticks_) {
      write_line(text, {left_, y_of(y)}, {right_, y_of(y)}, "stroke=\"#ddd\" stroke-width=\"0.5\"");
    }
  }

  void write_numbers(std::string& text) const {
    const char* const look = "stroke=\"#444\" stroke-width=\"0.75\"";
    const double tick = 0.3 * em_;
    for (const double y : y_ticks_) {
      write_line(text, {left_ - tick, y_of(y)}, {left_, y_of(y)}, look);
      label(text, left_ - 0.6 * em_, y_of(y) + 0.35 * em_, "end", tick_text(y));
    }
    for (std::size_t i = 0; i < axes_.y_classes.size(); ++i) {
      const double y = y_of(static_cast<double>(i));
      label(text, left_ - 0.6 * em_, y + 0.35 * em_, "end", axes_.y_classes[i]);
    }
    double beside = 1.1 * em_;
    for (const std::string& row_of_name : y_name()) {
      label_upward(text, beside, 0.5 * (top_ + low_), row_of_name);
      beside += kNameRow * em_;
    }
    if (axes_.y_classes.empty()) write_line(text, {left_, top_}, {left_, low_}, look);
    if (axes_.x_classes.empty()) write_line(text, {left_, low_}, {right_, low_}, look);
    for (const double x : x_ticks_) {
      write_line(text, {x_of(x), low_}, {x_of(x), low_ + tick}, look);
    }
    if (axes_.x_name.empty()) return;
    const double row = low_ + 1.4 * em_;
    for (const double x : x_ticks_) label(text, x_of(x), row, "middle", tick_text(x));
    double free = 0;
    for (std::size_t i = 0; i < axes_.x_classes.size(); ++i) {
      const double half = 0.5 * width_of(axes_.x_classes[i], em_);
      const double x = x_of(static_cast<double>(i));
      if (x - half < free) continue;  // names must not run into each other
      label(text, x, row, "middle", axes_.x_classes[i]);
      free = x + half + 0.3 * em_;
    }
    label(text, 0.5 * (left_ + right_), row + 1.4 * em_, "middle", axes_.x_name);
  }

  void write_curve(std::string& text, const Curve& curve, const char* colour) const {
    append(text, "<g opacity=\"%.2f\">\n", curve.opacity);
    if (curve.mark == Mark::Line || curve.mark == Mark::Dashes) {
      write_lines(text, curve, colour);
    } else {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (std::isfinite(curve.y[i])) write_mark(text, curve, i, colour);
      }
    }
    text += "</g>\n";
  }

  void write_lines(std::string& text, const Curve& curve, const char* colour) const {
    std::vector<Spot> line;
    for (std::size_t i = 0; i <= curve.x.size(); ++i) {
      if (i < curve.x.size() && std::isfinite(curve.y[i])) {
        line.push_back({x_of(curve.x[i]), y_of(curve.y[i])});
      } else if (!line.empty()) {
        write_polyline(text, outline(line), curve.mark, colour);
        line.clear();
      }
    }
  }
  void write_polyline(std::string& text,
                      const std::vector<Spot>& line,
                      Mark mark,
                      const char* colour) const {
    std::string points;
    for (const Spot& spot : line) append(points, "%.2f,%.2f ", spot.x, spot.y);
    append(text,
           "<polyline fill=\"none\" stroke-linejoin=\"round\" %s points=\"",
           look_of(mark, colour).c_str());
    text.append(points).append("\"/>\n");
  }

  [[nodiscard]] std::string look_of(Mark mark, const char* colour) const {
    std::string look;
    append(look, "stroke=\"%s\" stroke-width=\"%.2f\"", colour, style_.line);
    if (mark == Mark::Dashes) {
      append(look, " stroke-dasharray=\"%.1f %.1f\"", 3 * style_.line, 2 * style_.line);
    }
    return look;
  }

  void write_mark(std::string& text, const Curve& curve, std::size_t i, const char* colour) const {
    const Spot spot{x_of(curve.x[i]), y_of(curve.y[i])};
    if (curve.mark == Mark::Points) {
      write_point(text, spot, colour);
    } else if (curve.mark == Mark::Intervals) {
      write_interval(text, spot, y_of(curve.low[i]), y_of(curve.high[i]), colour);
    } else {
      const double width = (right_ - left_) / static_cast<double>(axes_.x_classes.size());
      write_cell(text, spot, 0.94 * width, (kCellHeight - 0.15) * em_, colour);
    }
  }
  void write_point(std::string& text, Spot at, const char* colour) const {
    append(text,
           "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.2f\" fill=\"none\" stroke=\"%s\" "
           "stroke-width=\"%.2f\"/>\n",
           at.x,
           at.y,
           kPointSize * em_,
           colour,
           0.7 * style_.line);
  }
  void write_interval(
      std::string& text, Spot at, double low, double high, const char* colour) const {
    write_line(text, {at.x, low}, {at.x, high}, look_of(Mark::Line, colour).c_str());
    append(text,
           "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.2f\" fill=\"%s\"/>\n",
           at.x,
           at.y,
           0.3 + 1.2 * style_.line,
           colour);
  }
  static void write_cell(
      std::string& text, Spot middle, double width, double height, const char* colour) {
    append(text,
           "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n",
           middle.x - 0.5 * width,
           middle.y - 0.5 * height,
           width,
           height,
           colour);
  }

  /// As many rows as the names need; `top_` is below them then.
  void write_legend(std::string& text) {
    double x = right_;
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const Curve& curve = curves_[c];
      if (curve.name.empty()) continue;
      const double width = kLegendSample * em_ + width_of(curve.name, em_);
      if (x > left_ && x + width > right_) {
        x = left_;
        top_ += kLegendRow * em_;
      }
      write_sample(text, curve, {x, top_ - 0.35 * em_}, colour_of(c));
      label(text, x + kLegendSample * em_, top_, "start", curve.name);
      x += width + kLegendGap * em_;
    }
  }
  void write_sample(std::string& text, const Curve& curve, Spot at, const char* colour) const {
    const Mark mark = curve.mark;
    append(text, "<g opacity=\"%.2f\">\n", curve.opacity);
    const double length = (kLegendSample - 0.5) * em_;
    const Spot middle{at.x + 0.5 * length, at.y};
    if (mark == Mark::Points) {
      write_point(text, middle, colour);
    } else if (mark == Mark::Intervals) {
      write_interval(text, middle, at.y - 0.5 * em_, at.y + 0.5 * em_, colour);
    } else if (mark == Mark::Cells) {
      write_cell(text, middle, length, em_, colour);
    } else {
      write_line(text, at, {at.x + length, at.y}, look_of(mark, colour).c_str());
    }
    text += "</g>\n";
  }

  const Axes& axes_;
  const std::vector<Curve>& curves_;
  const Style& style_;
  double em_;       ///< [pt], the letters' size
  double left_{};   ///< [pt], of the axes, as the three below
  double right_{};  ///< [pt]
  double top_{};    ///< [pt]
  double low_{};    ///< [pt]
  Range across_;
  Range up_;
  std::vector<double> x_ticks_;  ///< [as the axis]
  std::vector<double> y_ticks_;  ///< [as the axis]
};

}  // namespace

std::string figure_svg(const Figure& figure, const Style& style) {
  std::vector<PanelWriter> writers;
  double left = 0;
  for (const Panel& panel : figure.panels) {
    writers.emplace_back(panel, style);
    left = std::max(left, writers.back().left_needed());
  }
  std::string body;
  double top = 0.2 * style.text;
  if (style.titled && !figure.title.empty()) {
    title(body, left, top += 1.6 * style.text, figure.title);
    top += 0.4 * style.text;
  }
  for (PanelWriter& writer : writers) top = writer.write(body, left, top);
  return open_picture(style, top) + body + "</svg>\n";
}

}  // namespace palp::plot
