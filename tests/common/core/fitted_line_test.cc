// Goal: in a narrow line the less important is said in fewer words, and nothing else changes.
#include "common/core/fitted_line.h"

#include <array>

#include <gtest/gtest.h>

namespace palp {
namespace {

std::string line_of(std::size_t columns) {
  std::array<LinePart, 4> parts{
      {{"ENGAGED", "E", 3}, {"rtt 12.3 ms  loss 2.0 %", "rtt 12.3 ms", 1}, {}, {"taps B", "", 2}}};
  return fitted_line(parts, columns);
}

TEST(FittedLineTest, SaysAllWhereThereIsRoom) {
  EXPECT_EQ(line_of(0), "ENGAGED  rtt 12.3 ms  loss 2.0 %  taps B");
  EXPECT_EQ(line_of(40), line_of(0));
}

TEST(FittedLineTest, ShortensInOrderOfRankAndNoMoreThanNeeded) {
  EXPECT_EQ(line_of(39), "ENGAGED  rtt 12.3 ms  taps B");
  EXPECT_EQ(line_of(27), "ENGAGED  rtt 12.3 ms");
  EXPECT_EQ(line_of(19), "E  rtt 12.3 ms");
  EXPECT_EQ(line_of(1), "E  rtt 12.3 ms") << "the rest is the reader's to cut";
}

}  // namespace
}  // namespace palp
