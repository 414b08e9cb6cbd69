#include "common/core/printable.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

RC_GTEST_PROP(PrintableTest, IsOneShortLine, (const std::string& text)) {
  const std::string shown = printable(text);
  RC_ASSERT(shown.size() <= 83U);
  for (const char c : shown) {
    RC_ASSERT(c >= ' ' && c <= '~');
  }
}

TEST(PrintableTest, MarksWhereItCutsOff) {
  EXPECT_EQ(printable(std::string(80, 'a')), std::string(80, 'a'));
  EXPECT_EQ(printable(std::string(81, 'a')), std::string(80, 'a') + "...");
  EXPECT_EQ(printable("a\nb\x1b"), "a?b?");
}

/// Any bytes, and among them often what acts.
std::string acting_text() {
  std::string text;
  for (const int which : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 262))) {
    constexpr const char* kOften[] = {
        "\x1b[2J", "\xc2\x9b", "\xe2\x80\xae", "\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x98\x80"};
    if (which < 256) {
      text += static_cast<char>(which);
    } else {
      text += kOften[which - 256];
    }
  }
  return text;
}

RC_GTEST_PROP(HarmlessTest, NothingThatATerminalObeysIsLeft, ()) {
  const std::string text = acting_text();
  const std::string line = harmless_line(text);
  RC_ASSERT(line.size() <= text.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto byte = static_cast<unsigned char>(line[i]);
    RC_ASSERT(byte >= 0x20 && byte != 0x7f);
    RC_ASSERT(!(byte == 0xc2 && static_cast<unsigned char>(line[i + 1]) < 0xa0));
  }
  RC_ASSERT(line.find("\xe2\x80\xae") == std::string::npos);
  RC_ASSERT(harmless_line(line) == line);
  const std::string lines = harmless(text);
  RC_ASSERT(std::count(lines.begin(), lines.end(), '\n') ==
            std::count(text.begin(), text.end(), '\n'));
}

TEST(HarmlessTest, WordsOfAllLanguagesStay) {
  for (const char* words :
       {"stiff tissue", "Härte in N/m", "硬さ", "жёсткость", "\xf0\x9f\x98\x80"}) {
    EXPECT_EQ(harmless(words), words);
    EXPECT_EQ(harmless_line(words), words);
  }
  EXPECT_EQ(harmless("a\tb\nc\r\x1b[31m"), "a\tb\nc??[31m");
  EXPECT_EQ(harmless_line("a\nb"), "a?b");
  EXPECT_EQ(harmless("\x9b\xc0\x80\xed\xa0\x80\xe2\x82"),
            "????"
            "???"
            "?")
      << "no UTF-8";
}

}  // namespace
}  // namespace palp
