#include "netem/model/chance_draw.h"

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

/// All that can strike, seldom enough that runs are quiet.
Impairment everything() {
  Impairment law;
  law.loss = {0.01, 0.5};
  law.duplicate = {0.01, 0.2};
  law.corrupt = {0.01, 0};
  law.truncate = {0.01, 0};
  law.state = FourStateLaw{.p13 = 0.01, .p31 = 0.4, .p32 = 0.1, .p14 = 0.01};
  law.gemodel = GemodelLaw{.to_bad = 0.01, .to_good = 0.3};
  law.reorder = {{0.02, 0.1}, 1};
  law.order = Order::Swap;
  law.swap = {0.02, 0};
  return law;
}

/// Goal: nobody need be asked about a quiet datagram. Method: one is asked about each, one about
/// those only that are not quiet, while the law changes and leans; they say the same.
TEST(ChanceDrawTest, WhoIsAskedOnlyWhenNotQuietSaysWhatWhoIsAlwaysAskedSays) {
  const Impairment first = everything();
  Impairment other = everything();
  other.loss.share = other.corrupt.share = 0.05;
  other.order = Order::Keep;
  other.reorder.gap = 0;
  const Streams streams{5, Direction::Up};
  ChanceDraw always{first, streams};
  ChanceDraw seldom{first, streams};
  int quiet = 0;
  for (std::uint64_t index = 0; index < 30'000; ++index) {
    for (ChanceDraw* draw : {&always, &seldom}) {
      if (index == 7'001) draw->change(other, index);
      if (index == 14'003) draw->change(first, index);
      if (index > 20'000 && index % 997 == 0) draw->lean(other, 0.5, index);
    }
    const Chances said = always.next(index);
    if (seldom.quiet(index)) {
      ++quiet;
      ASSERT_EQ(said, Chances{}) << index;
    } else {
      ASSERT_EQ(seldom.next(index), said) << index;
    }
  }
  EXPECT_GT(quiet, 15'000);
}

TEST(ChanceDrawTest, AwakeItIsQuietAboutNobody) {
  Impairment law;
  ChanceDraw draw{law, Streams{5, Direction::Up}};
  EXPECT_EQ(draw.next(0), Chances{});
  EXPECT_TRUE(draw.quiet(1));
  draw.wake();
  EXPECT_FALSE(draw.quiet(1));
}

TEST(ChanceDrawTest, OfEachGapOneGoesAhead) {
  Impairment law;
  law.reorder = {{1, 0}, 3};
  ChanceDraw draw{law, Streams{5, Direction::Up}};
  for (std::uint64_t index = 0; index < 30; ++index) {
    EXPECT_FALSE(draw.quiet(index));
    EXPECT_EQ(draw.next(index).jumps, index % 3 == 2) << index;
  }
}

TEST(ChanceDrawTest, ACopySharesWhatSweepsAllAndNeverChangesTheOrder) {
  Impairment law = everything();
  law.loss = law.truncate = {1, 0};
  law.corrupt = {};
  const ChanceDraw draw{law, Streams{5, Direction::Up}};
  const Chances original{.duplicate = true,
                         .swept = true,
                         .loss_gemodel = 0.25,
                         .flipped = true,
                         .jumps = true,
                         .swaps = true};
  const Chances copy = draw.of_copy(original, 1, 0);
  EXPECT_EQ(copy, (Chances{.lost = true, .swept = true, .loss_gemodel = 0.25, .cut = true}));
}

}  // namespace
}  // namespace palp::netem
