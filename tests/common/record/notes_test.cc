#include "common/record/notes.h"

#include <set>

#include <gtest/gtest.h>

namespace palp::record {
namespace {

TEST(NotesTest, EveryNumberHasItsOwnTextAndOthersSaySo) {
  std::set<std::string_view> texts;
  int known = 0;
  for (int code = 1; code < 65536; ++code) {
    const auto text = note_text(static_cast<std::uint16_t>(code));
    if (text != "unknown note") {
      ++known;
      EXPECT_TRUE(texts.insert(text).second) << code << ": " << text;
    }
  }
  EXPECT_EQ(known, 24);
}

}  // namespace
}  // namespace palp::record
