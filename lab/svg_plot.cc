#include "lab/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace palp::lab {
namespace {

constexpr double kWidth = 760;   // [px]
constexpr double kHeight = 440;  // [px]
constexpr double kLeft = 70;
constexpr double kRight = 130;
constexpr double kTop = 40;
constexpr double kBottom = 50;
constexpr int kTicks = 5;
// Okabe and Ito's colours: told apart by nearly everybody.
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  std::array<char, 400> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  text += line.data();
}

void head(std::string& text, double width, double height, const std::string& title) {
  append(text,
         "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
         "font-family=\"sans-serif\" font-size=\"12\">\n"
         "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
         "<text x=\"%.0f\" y=\"22\" font-size=\"15\">%s</text>\n",
         width,
         height,
         kLeft,
         title.c_str());
}

void label(std::string& text, double x, double y, const char* anchor, const std::string& words) {
  append(text,
         "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n",
         x,
         y,
         anchor,
         words.c_str());
}

std::string short_number(double value) {
  std::array<char, 24> digits{};
  std::snprintf(digits.data(), digits.size(), "%.3g", value);
  return digits.data();
}

struct Range {
  double from{INFINITY};  ///< [as the axis]
  double to{-INFINITY};   ///< [as the axis]
  void add(double value) {
    if (!std::isfinite(value)) return;
    from = std::min(from, value);
    to = std::max(to, value);
  }
  [[nodiscard]] double share(double value) const {
    return to > from ? (value - from) / (to - from) : 0.5;
  }
};

}  // namespace

std::string curves_svg(const Axes& axes, const std::vector<Curve>& curves) {
  // A round trip of 0 has no logarithm; 1 ms is the tick below which nothing differs.
  const auto place = [&](double x) {
    return axes.x_logarithmic ? std::log10(std::max(x, 1.0)) : x;
  };
  Range across;
  Range up;
  for (const Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      across.add(place(curve.x[i]));
      up.add(curve.y[i]);
    }
  }
  if (axes.y_to > axes.y_from) up = {axes.y_from, axes.y_to};
  const double wide = kWidth - kLeft - kRight;
  const double high = kHeight - kTop - kBottom;
  const auto x_of = [&](double x) { return kLeft + wide * across.share(place(x)); };
  const auto y_of = [&](double y) { return kTop + high * (1 - std::clamp(up.share(y), 0.0, 1.0)); };
  std::string text;
  head(text, kWidth, kHeight, axes.title);
  for (int i = 0; i <= kTicks; ++i) {
    const double y = up.from + (up.to - up.from) * i / kTicks;
    append(text,
           "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n",
           kLeft,
           kLeft + wide,
           y_of(y),
           y_of(y));
    label(text, kLeft - 6, y_of(y) + 4, "end", short_number(y));
  }
  if (!curves.empty() && curves.front().x.size() <= 16) {
    for (const double x : curves.front().x) {
      label(text, x_of(x), kTop + high + 18, "middle", short_number(x));
    }
  } else {
    for (int i = 0; i <= kTicks; ++i) {
      const double share = static_cast<double>(i) / kTicks;
      const double at = across.from + (across.to - across.from) * share;
      label(text,
            kLeft + wide * share,
            kTop + high + 18,
            "middle",
            short_number(axes.x_logarithmic ? std::pow(10, at) : at));
    }
  }
  label(text, kLeft + wide / 2, kHeight - 10, "middle", axes.x_name);
  append(text,
         "<text transform=\"translate(16 %.1f) rotate(-90)\" text-anchor=\"middle\">%s</text>\n",
         kTop + high / 2,
         axes.y_name.c_str());
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Curve& curve = curves[c];
    const char* colour = kColours[c % kColours.size()];
    std::string points;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (std::isfinite(curve.y[i]))
        append(points, "%.1f,%.1f ", x_of(curve.x[i]), y_of(curve.y[i]));
    }
    text += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"";
    text.append(colour).append("\" points=\"").append(points).append("\"/>\n");
    const double y = kTop + 16 + 18 * static_cast<double>(c);
    append(text,
           "<line x1=\"%.0f\" x2=\"%.0f\" y1=\"%.0f\" y2=\"%.0f\" stroke=\"%s\" "
           "stroke-width=\"2\"/>\n",
           kWidth - kRight + 12,
           kWidth - kRight + 36,
           y - 4,
           y - 4,
           colour);
    label(text, kWidth - kRight + 42, y, "start", curve.name);
  }
  return text + "</svg>\n";
}

std::string map_svg(const Plan& plan, const std::vector<CaseResult>& results) {
  const auto at = [&](const std::string& name) {
    const auto found = std::find(plan.label_names.begin(), plan.label_names.end(), name);
    return static_cast<std::size_t>(found - plan.label_names.begin());
  };
  const std::size_t spring_at = at("k_p_n_per_m");
  const std::size_t trip_at = at("rtt_ms");
  const std::size_t grip_at = at("grip");
  std::vector<std::string> springs;
  std::vector<std::string> trips;
  std::vector<std::string> grips;
  const auto index_in = [](std::vector<std::string>& list, const std::string& value) {
    auto found = std::find(list.begin(), list.end(), value);
    if (found == list.end()) found = list.insert(list.end(), value);
    return static_cast<double>(found - list.begin());
  };
  constexpr double kCell = 22;
  constexpr double kPanel = 8 * kCell + 46;
  std::string cells;
  for (const CaseResult& result : results) {
    const double row = index_in(springs, result.labels[spring_at]);
    const double column = index_in(trips, result.labels[trip_at]);
    const double panel = index_in(grips, result.labels[grip_at]);
    append(cells,
           "<rect x=\"%.0f\" y=\"%.0f\" width=\"20\" height=\"20\" fill=\"%s\"/>\n",
           kLeft + 30 + kCell * column,
           kTop + 20 + kPanel * panel + kCell * row,
           result.unstable ? "#d55e00" : "#009e73");
  }
  std::string text;
  const double width = kLeft + 60 + kCell * static_cast<double>(trips.size());
  head(text,
       width,
       kTop + kPanel * static_cast<double>(grips.size()) + 10,
       "eq. (1): stable (green), unstable (orange)");
  for (std::size_t g = 0; g < grips.size(); ++g) {
    const double top = kTop + 20 + kPanel * static_cast<double>(g);
    label(text, kLeft + 30, top - 6, "start", "grip " + grips[g]);
    for (std::size_t r = 0; r < springs.size(); ++r) {
      label(text, kLeft + 24, top + 15 + kCell * static_cast<double>(r), "end", springs[r]);
    }
    for (std::size_t c = 0; c < trips.size(); ++c) {
      label(text,
            kLeft + 40 + kCell * static_cast<double>(c),
            top + kCell * 8 + 12,
            "middle",
            trips[c]);
    }
  }
  label(text, 6, kTop + 8, "start", "k_p N/m by round trip ms");
  return text + cells + "</svg>\n";
}

}  // namespace palp::lab
