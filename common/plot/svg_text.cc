#include "common/plot/svg_text.h"

#include <array>
#include <cstdarg>
#include <cstdio>

#include "common/core/printable.h"

namespace palp::plot {
namespace {

std::string escaped(const std::string& words) {
  std::string out;
  for (const char c : harmless_line(words)) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

void append(std::string& text, const char* format, ...) {
  std::array<char, 400> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  text += line.data();
}

std::string open_picture(double width, double height) {
  std::string text;
  append(text,
         "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
         "font-family=\"sans-serif\" font-size=\"12\">\n"
         "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
         width,
         height);
  return text;
}

void label(std::string& text, double x, double y, const char* anchor, const std::string& words) {
  append(text, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
  text.append(escaped(words)).append("</text>\n");
}

void title(std::string& text, double x, double y, const std::string& words) {
  append(text, "<text x=\"%.1f\" y=\"%.1f\" font-size=\"15\">", x, y);
  text.append(escaped(words)).append("</text>\n");
}

}  // namespace palp::plot
