#include "depth/depth_database.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "depth/embedded_database.h"
#include "fem/database_builder.h"

namespace palp::depth {
namespace {

const DepthDatabase& database() {
  static const DepthDatabase one = *default_database();
  return one;
}

TEST(DepthDatabaseTest, TheOneInTheProgramIsWholeAndSmall) {
  EXPECT_LT(embedded_database().size(), 1'000'000U);
  const auto table = fem::parse_table(embedded_database());
  ASSERT_TRUE(table) << table.error().text;
  EXPECT_EQ(table->members.size(), fem::cells_of(table->grid).size() * table->grid.ratios.size());
  EXPECT_TRUE(table->grid == fem::default_grid());
}

TEST(DepthDatabaseTest, GivesBackWhatWasSolvedAtTheGrid) {
  const auto table = fem::parse_table(embedded_database());
  for (std::size_t i = 0; i < table->members.size(); i += 97) {
    const fem::DepthMember& member = table->members[i];
    const auto curve = database().curve({.shape = member.shape,
                                         .depth = table->grid.depths[member.depth],
                                         .radius = table->grid.radii[member.radius],
                                         .ratio = table->grid.ratios[member.ratio]});
    for (std::size_t j = 0; j < member.excess.size(); ++j) {
      const double wanted = table->plain[j] * (1 + static_cast<double>(member.excess[j]));
      EXPECT_NEAR(database().force(curve, table->grid.indentations[j]) / wanted, 1, 1e-6);
    }
  }
}

TEST(DepthDatabaseTest, TenRandomMembersComeOutAgainWhenSolved) {
  const auto table = fem::parse_table(embedded_database());
  fem::DepthGrid grid = table->grid;
  for (std::uint64_t draw = 0; draw < 10; ++draw) {
    const auto at = static_cast<std::size_t>(random_uniform(5, 1, draw) *
                                             static_cast<double>(table->members.size()));
    const fem::DepthMember& member = table->members[at];
    fem::DepthGrid single = grid;
    single.ratios = {grid.ratios[member.ratio]};
    const auto again = fem::solve_cell(single, {member.shape, member.depth, member.radius});
    ASSERT_EQ(again.size(), 1U);
    ASSERT_EQ(again[0].excess.size(), member.excess.size());
    for (std::size_t j = 0; j < member.excess.size(); ++j) {
      EXPECT_NEAR(1 + again[0].excess[j], 1 + member.excess[j], 1e-4);
    }
  }
}

TEST(DepthDatabaseTest, AnInclusionStiffensAndADeeperOneLess) {
  const auto plain = database().plain();
  const auto near = database().curve({.depth = 6e-3, .radius = 8e-3, .ratio = 100});
  const auto far = database().curve({.depth = 14e-3, .radius = 8e-3, .ratio = 100});
  for (const double d : {0.1e-3, 0.5e-3, 1e-3, 2.3e-3, 4e-3}) {
    EXPECT_GT(database().force(far, d), database().force(plain, d));
    EXPECT_GT(database().force(near, d), database().force(far, d));
  }
  EXPECT_EQ(database().force(near, 0), 0);
}

TEST(DepthDatabaseTest, TheSlopeDoesNotJumpAtTheGrid) {
  const double node = database().grid().depths[7];
  const auto force = [&](double depth) {
    return database().force(database().curve({.depth = depth, .radius = 7e-3, .ratio = 40}), 3e-3);
  };
  const double step = 1e-5;
  const double left = (force(node) - force(node - step)) / step;
  const double right = (force(node + step) - force(node)) / step;
  EXPECT_NEAR(right / left, 1, 0.02);
}

TEST(DepthDatabaseTest, SaysWhatItDoesNotHold) {
  EXPECT_TRUE(database().contains({.depth = 12e-3, .radius = 8e-3, .ratio = 200}));
  EXPECT_FALSE(database().contains({.depth = 2e-3, .radius = 8e-3, .ratio = 200}));
  EXPECT_FALSE(database().contains({.depth = 12e-3, .radius = 17e-3, .ratio = 200}));
  EXPECT_FALSE(database().contains({.depth = 12e-3, .radius = 8e-3, .ratio = 2}));
  EXPECT_FALSE(database().contains({.depth = 27e-3, .radius = 16e-3, .ratio = 200}));
  EXPECT_FALSE(load_database("/nonexistent"));
}

}  // namespace
}  // namespace palp::depth
