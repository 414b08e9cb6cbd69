#include "common/plot/svg_text.h"

#include <array>
#include <cstdarg>
#include <cstdio>

#include "common/core/printable.h"

namespace palp::plot {
namespace {

// In sizes of the letters, of a font as wide as any that a machine has in place of Helvetica.
constexpr double kLetterWidth = 0.52;
constexpr double kDigitWidth = 0.64;

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

std::string open_picture(const Style& style, double height) {
  std::string text{"<svg xmlns=\"http://www.w3.org/2000/svg\" "};
  // On a screen a picture is as large as its place; on paper it has its size.
  if (!style.titled) append(text, "width=\"%.2fpt\" height=\"%.2fpt\" ", style.width, height);
  append(text,
         "viewBox=\"0 0 %.2f %.2f\" font-family=\"Helvetica, Arial, sans-serif\" "
         "font-size=\"%.0f\">\n"
         "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
         style.width,
         height,
         style.text);
  return text;
}

void label(std::string& text, double x, double y, const char* anchor, const std::string& words) {
  append(text, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
  text.append(escaped(words)).append("</text>\n");
}

void title(std::string& text, double x, double y, const std::string& words) {
  append(text, "<text x=\"%.1f\" y=\"%.1f\" font-size=\"125%%\">", x, y);
  text.append(escaped(words)).append("</text>\n");
}

void label_upward(std::string& text, double x, double y, const std::string& words) {
  append(
      text, "<text transform=\"translate(%.1f %.1f) rotate(-90)\" text-anchor=\"middle\">", x, y);
  text.append(escaped(words)).append("</text>\n");
}

double width_of(const std::string& words, double size) {
  double width = 0;
  for (const char c : words) {
    if ((c & 0xC0) == 0x80) continue;  // goes on with a letter of UTF-8
    width += c >= '0' && c <= '9' ? kDigitWidth : kLetterWidth;
  }
  return size * width;
}

}  // namespace palp::plot
