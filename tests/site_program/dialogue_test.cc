#include "site_program/dialogue.h"

#include <sstream>

#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

TEST(DialogueTest, OnlyYesIsYesAndNobodyIsNo) {
  std::istringstream in{"yes\nYES\n"};
  std::ostringstream out;
  Dialogue talk{in, out};
  EXPECT_TRUE(talk.confirm("Shall it?"));
  EXPECT_FALSE(talk.confirm("Shall it?"));
  EXPECT_FALSE(talk.confirm("Shall it?"));
  EXPECT_EQ(out.str().substr(0, 25), "Shall it? (yes or no) Sha");
}

TEST(DialogueTest, ANumberIsAskedForThreeTimesAndLiesInItsRange) {
  std::istringstream in{"ten\n-1\n 5.5 \r\nnan\n11\n\n"};
  std::ostringstream out;
  Dialogue talk{in, out};
  EXPECT_EQ(talk.number("mm?", 0, 10), 5.5);
  EXPECT_EQ(talk.number("mm?", 0, 10), std::nullopt);
}

TEST(DialogueTest, OneOfSomeAnswersOrNone) {
  std::istringstream in{"up\nout\nx\ny\nz\n"};
  std::ostringstream out;
  Dialogue talk{in, out};
  EXPECT_EQ(talk.one_of("Which way?", {"in", "out"}), "out");
  EXPECT_EQ(talk.one_of("Which way?", {"in", "out"}), std::nullopt);
  EXPECT_FALSE(talk.wait_for_enter("Let go."));
}

TEST(DialogueTest, WordsAreAtMostTwoHundred) {
  EXPECT_EQ(words("%.1f mm", 2.04), "2.0 mm");
  EXPECT_EQ(words("%s", std::string(500, 'x').c_str()).size(), 199U);
}

}  // namespace
}  // namespace palp::site_program
