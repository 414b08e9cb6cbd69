#pragma once

#include <string>

/// Pictures a person can look at, as SVG text without any style sheet or script.
namespace palp::plot {

/// As printf, at the end of `text`; at most 400 characters.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...);

/// The beginning of a picture of that many pixels, white. "</svg>\n" ends it.
[[nodiscard]] std::string open_picture(double width, double height);

/// `anchor`: "start", "middle", "end". The words may hold any characters. Places in pixels.
void label(std::string& text, double x, double y, const char* anchor, const std::string& words);
void title(std::string& text, double x, double y, const std::string& words);

}  // namespace palp::plot
