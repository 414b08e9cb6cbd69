#include "netem/model/place_pool.h"

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

TEST(PlacePoolTest, EachKeepsItsOwnUntilAnotherEnters) {
  PlacePool pool{3};
  for (std::uint32_t i = 0; i < 3; ++i) {
    Decision decision{.index = i};
    ASSERT_TRUE(pool.enter(decision));
    EXPECT_EQ(decision.place, i);
    EXPECT_EQ(pool[i].place, i);
  }
  pool.leave(1);
  EXPECT_EQ(pool[1].index, 1U);
  Decision next{.index = 7};
  ASSERT_TRUE(pool.enter(next));
  EXPECT_EQ(next.place, 1U);
  EXPECT_EQ(pool[0].index, 0U);
  EXPECT_EQ(pool[1].index, 7U);
  EXPECT_EQ(pool[2].index, 2U);
}

TEST(PlacePoolTest, FullItTakesNobody) {
  PlacePool pool{1};
  Decision first;
  Decision second{.index = 5, .place = 9};
  ASSERT_TRUE(pool.enter(first));
  EXPECT_FALSE(pool.enter(second));
  EXPECT_EQ(second.place, 9U);
  EXPECT_EQ(pool[0].index, 0U);
}

}  // namespace
}  // namespace palp::netem
