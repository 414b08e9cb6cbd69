#pragma once

#include <string>

#include "common/plot/style.h"

/// Pictures a person can look at, as SVG text without any style sheet or script. All places and
/// lengths are points.
namespace palp::plot {

/// As printf, at the end of `text`; at most 400 characters.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...);

/// The beginning of a white picture, as wide as the style says. "</svg>\n" ends it.
[[nodiscard]] std::string open_picture(const Style& style, double height);

/// `anchor`: "start", "middle", "end". The words may hold any characters.
void label(std::string& text, double x, double y, const char* anchor, const std::string& words);
/// The same, larger.
void title(std::string& text, double x, double y, const std::string& words);
/// The same as label(), upward, with its middle at the place.
void label_upward(std::string& text, double x, double y, const std::string& words);

/// [pt], about what the words take in letters of that size.
[[nodiscard]] double width_of(const std::string& words, double size);

}  // namespace palp::plot
