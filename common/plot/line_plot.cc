#include "common/plot/line_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/plot/svg_text.h"

namespace palp::plot {
namespace {

constexpr double kWidth = 760;   // [px]
constexpr double kHeight = 440;  // [px], of a panel
constexpr double kLeft = 70;
constexpr double kRight = 170;
constexpr double kTop = 40;
constexpr double kBottom = 50;
constexpr int kTicks = 5;
constexpr std::size_t kTicksMax = 14;
constexpr double kTickGap = 34;  // [px], "444.6" fits
// Okabe and Ito's colours: told apart by nearly everybody.
constexpr std::array kColours{
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

std::string short_number(double value) {
  std::array<char, 24> digits{};
  std::snprintf(digits.data(), digits.size(), "%.4g", value);
  return digits.data();
}

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

/// 1, 2 and 5 times the powers of ten, between two logarithms to the base of ten.
std::vector<double> decade_ticks(double from, double to) {
  std::vector<double> ticks;
  for (int power = static_cast<int>(std::floor(from)); power <= to; ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, power);
      if (std::log10(tick) >= from - 1e-9 && std::log10(tick) <= to + 1e-9) ticks.push_back(tick);
    }
  }
  return ticks;
}

/// Draws one panel whose upper left corner is (0, top).
class PanelWriter {
 public:
  PanelWriter(const Panel& panel, double top)
      : axes_{panel.axes}, curves_{panel.curves}, top_{top + kTop} {
    for (const Curve& curve : curves_) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (!std::isfinite(curve.y[i])) continue;
        across_.add(place(curve.x[i]));
        up_.add(curve.y[i]);
      }
    }
    if (axes_.y_to > axes_.y_from) up_ = {axes_.y_from, axes_.y_to};
    if (!(up_.from <= up_.to)) up_ = {0, 1};
    if (!(across_.from <= across_.to)) across_ = {0, 1};
    y_ticks_ = round_ticks(up_.from, up_.to, kTicks);
    up_ = {y_ticks_.front(), y_ticks_.back()};
    if (axes_.x_logarithmic) {
      x_ticks_ = curves_.empty() ? std::vector<double>{} : curves_.front().x;
      if (x_ticks_.size() > kTicksMax || crowded()) {
        x_ticks_ = decade_ticks(across_.from, across_.to);
      }
      if (x_ticks_.empty()) x_ticks_ = {std::pow(10, across_.from), std::pow(10, across_.to)};
      return;
    }
    x_ticks_ = round_ticks(across_.from, across_.to, kTicks);
    across_ = {x_ticks_.front(), x_ticks_.back()};
  }

  void write(std::string& text) const {
    title(text, kLeft, top_ - 18, axes_.title);
    write_axes(text);
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const int colour = curves_[c].colour >= 0 ? curves_[c].colour : static_cast<int>(c);
      write_curve(text, curves_[c], kColours[static_cast<std::size_t>(colour) % kColours.size()]);
    }
    write_legend(text);
  }

 private:
  /// Whether numbers below the axis would run into each other.
  [[nodiscard]] bool crowded() const {
    std::vector<double> places;
    for (const double x : x_ticks_) places.push_back(x_of(x));
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (places[i] - places[i - 1] < kTickGap) return true;
    }
    return false;
  }
  // A round trip of 0 has no logarithm; below 1 nothing differs.
  [[nodiscard]] double place(double x) const {
    return axes_.x_logarithmic ? std::log10(std::max(x, 1.0)) : x;
  }
  [[nodiscard]] double x_of(double x) const {
    return kLeft + (kWidth - kLeft - kRight) * across_.share(place(x));
  }
  [[nodiscard]] double y_of(double y) const {
    return top_ + (kHeight - kTop - kBottom) * (1 - std::clamp(up_.share(y), 0.0, 1.0));
  }

  void write_axes(std::string& text) const {
    const double low = top_ + kHeight - kTop - kBottom;
    for (const double y : y_ticks_) {
      append(text,
             "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n",
             kLeft,
             kWidth - kRight,
             y_of(y),
             y_of(y));
      label(text, kLeft - 6, y_of(y) + 4, "end", short_number(y));
    }
    for (const double x : x_ticks_) {
      append(text,
             "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#999\"/>\n",
             x_of(x),
             x_of(x),
             low,
             low + 4);
      label(text, x_of(x), low + 18, "middle", short_number(x));
    }
    label(text, 0.5 * (kLeft + kWidth - kRight), low + 40, "middle", axes_.x_name);
    append(text,
           "<text transform=\"translate(16 %.1f) rotate(-90)\" text-anchor=\"middle\">%s</text>\n",
           0.5 * (top_ + low),
           axes_.y_name.c_str());
  }

  void write_curve(std::string& text, const Curve& curve, const char* colour) const {
    if (curve.mark == Mark::Points) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (std::isfinite(curve.y[i]))
          write_point(text, x_of(curve.x[i]), y_of(curve.y[i]), colour);
      }
      return;
    }
    std::string points;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (std::isfinite(curve.y[i])) {
        append(points, "%.1f,%.1f ", x_of(curve.x[i]), y_of(curve.y[i]));
      }
    }
    text += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"";
    text.append(colour).append(curve.mark == Mark::Dashes ? "\" stroke-dasharray=\"6 4" : "");
    text.append("\" points=\"").append(points).append("\"/>\n");
  }

  static void write_point(std::string& text, double x, double y, const char* colour) {
    append(text,
           "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"none\" stroke-width=\"2\" "
           "stroke=\"%s\"/>\n",
           x,
           y,
           colour);
  }

  void write_legend(std::string& text) const {
    double y = top_ + 12;
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const Curve& curve = curves_[c];
      if (curve.name.empty()) continue;
      const auto colour = static_cast<std::size_t>(curve.colour >= 0 ? curve.colour : int(c));
      const char* const name = kColours[colour % kColours.size()];
      const double x = kWidth - kRight + 12;
      if (curve.mark == Mark::Points) {
        write_point(text, x + 12, y, name);
      } else {
        append(text,
               "<line x1=\"%.0f\" x2=\"%.0f\" y1=\"%.0f\" y2=\"%.0f\" stroke=\"%s\" "
               "stroke-width=\"2\"%s/>\n",
               x,
               x + 24,
               y,
               y,
               name,
               curve.mark == Mark::Dashes ? " stroke-dasharray=\"6 4\"" : "");
      }
      label(text, x + 30, y + 4, "start", curve.name);
      y += 18;
    }
  }

  const Axes& axes_;
  const std::vector<Curve>& curves_;
  double top_;  ///< [px], of the plot itself
  Range across_;
  Range up_;
  std::vector<double> x_ticks_;  ///< [as the axis]
  std::vector<double> y_ticks_;  ///< [as the axis]
};

}  // namespace

std::vector<double> round_ticks(double from, double to, int count) {
  if (!(to > from)) return {from - 0.5, from + 0.5};
  const double rough = (to - from) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= 0.8 * rough) step = factor * power;
  }
  const double first = std::floor(from / step + 1e-9);
  std::vector<double> ticks{first * step};
  while (ticks.back() < to - 1e-9 * step) {
    ticks.push_back((first + static_cast<double>(ticks.size())) * step);
  }
  return ticks;
}

std::string curves_svg(const Axes& axes, const std::vector<Curve>& curves) {
  return panels_svg({{axes, curves}});
}

std::string panels_svg(const std::vector<Panel>& panels) {
  std::string text = open_picture(kWidth, kHeight * static_cast<double>(panels.size()));
  double top = 0;
  for (const Panel& panel : panels) {
    PanelWriter{panel, top}.write(text);
    top += kHeight;
  }
  return text + "</svg>\n";
}

}  // namespace palp::plot
