#include "common/core/map_doubt.h"

#include <set>

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(MapDoubtTest, EachHasABitAReasonAndARemedyOfItsOwn) {
  MapDoubts all = 0;
  std::set<std::string_view> words;
  for (std::size_t i = 0; i < kMapDoubts; ++i) {
    const auto one = static_cast<MapDoubt>(i);
    EXPECT_EQ(all & doubts_of(one), 0U);
    all |= doubts_of(one);
    words.insert(reason_of(one));
    words.insert(remedy_of(one));
  }
  EXPECT_EQ(words.size(), 2 * kMapDoubts);
  EXPECT_FALSE(words.contains("?"));
}

TEST(MapDoubtTest, WhyItIsEnoughIsSaid) {
  EXPECT_EQ(to_string(MapStop::GoOn), "");
  EXPECT_NE(to_string(MapStop::Known), to_string(MapStop::NoMoreNews));
}

}  // namespace
}  // namespace palp
