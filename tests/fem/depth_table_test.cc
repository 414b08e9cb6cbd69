#include "fem/depth_table.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "fem/database_builder.h"
#include "fem/database_command.h"
#include "tests/support/own_path.h"

namespace palp::fem {
namespace {

DepthTable small_table() {
  DepthTable table;
  table.grid.depths = {5e-3, 10e-3};
  table.grid.radii = {5e-3, 8e-3};
  table.grid.ratios = {10, 100};
  table.grid.indentations = {1e-3, 2e-3};
  table.plain = {0.06, 0.16};
  table.members = {{InclusionShape::Ball, 0, 1, 0, {0.1F, 0.2F}},
                   {InclusionShape::Cylinder, 1, 0, 1, {0.3F}}};
  return table;
}

TEST(DatabaseCommandTest, AMissingFileCannotBeOpenedAForeignOneIsBadInput) {
  EXPECT_EQ(run_info({.file = "/nonexistent/file.bin"}).code, config::ExitCode::CannotOpen);
  const auto merged = run_merge({.files = {"/nonexistent/file.bin"}});
  EXPECT_EQ(merged.code, config::ExitCode::CannotOpen);
  EXPECT_NE(merged.text.find("/nonexistent/file.bin"), std::string::npos);
  const std::string foreign = test::own_path("depth_table_test.bin");
  std::ofstream{foreign} << "no database";
  EXPECT_EQ(run_info({.file = foreign}).code, config::ExitCode::BadInput);
}

TEST(DepthTableTest, ComesBackFromItsBytes) {
  const DepthTable table = small_table();
  const auto back = parse_table(table_bytes(table));
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_TRUE(back->grid == table.grid);
  ASSERT_EQ(back->members.size(), 2U);
  EXPECT_EQ(back->members[0].excess, table.members[0].excess);
  EXPECT_EQ(table_bytes(*back), table_bytes(table));
}

/// A ball's effect beside its axis, at two offsets.
ShapeTable small_shape() {
  return {.depths = {5e-3},
          .radii = {5e-3},
          .ratios = {10},
          .offsets = {0.5, 1},
          .indentations = {2e-3},
          .shape = {0.6F, 0.2F}};
}

TEST(DepthTableTest, TheShapeBesideTheAxisComesBackInSixteenBits) {
  DepthTable table = small_table();
  EXPECT_FALSE(parse_table(table_bytes(table))->off_axis);
  table.off_axis = small_shape();
  const auto back = parse_table(table_bytes(table));
  ASSERT_TRUE(back) << back.error().text;
  ASSERT_TRUE(back->off_axis);
  EXPECT_EQ(back->off_axis->offsets, table.off_axis->offsets);
  EXPECT_NEAR(back->off_axis->depths[0], 5e-3, 1e-15);
  ASSERT_EQ(back->off_axis->shape.size(), 2U);
  EXPECT_NEAR(back->off_axis->shape[0], 0.6, 0.5 / 65535);
  EXPECT_NEAR(back->off_axis->shape[1], 0.2, 0.5 / 65535);
  EXPECT_EQ(table_bytes(*back), table_bytes(table));
  table.off_axis->shape.pop_back();
  EXPECT_FALSE(parse_table(table_bytes(table)));
  DepthTable merged = small_table();
  ASSERT_TRUE(merge_table(merged, *back));
  EXPECT_TRUE(merged.off_axis);
}

TEST(DepthTableTest, RefusesWhatIsTruncatedForeignOrDamaged) {
  const std::string bytes = table_bytes(small_table());
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{7}, std::size_t{15}, bytes.size() - 1}) {
    EXPECT_FALSE(parse_table(bytes.substr(0, length))) << length;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    EXPECT_FALSE(parse_table(damaged)) << i;
  }
}

TEST(DepthTableTest, RefusesAMemberTwiceOrOutsideTheGrid) {
  DepthTable twice = small_table();
  twice.members.push_back(twice.members[0]);
  EXPECT_FALSE(parse_table(table_bytes(twice)));
  DepthTable outside = small_table();
  outside.members[0].radius = 2;
  EXPECT_FALSE(parse_table(table_bytes(outside)));
  DepthTable falling = small_table();
  falling.grid.depths = {10e-3, 5e-3};
  EXPECT_FALSE(parse_table(table_bytes(falling)));
}

TEST(DepthTableTest, MergeKeepsBothAndRefusesAnotherGrid) {
  DepthTable one = small_table();
  DepthTable other = small_table();
  other.members[0].ratio = 1;
  ASSERT_TRUE(merge_table(one, other));
  EXPECT_EQ(one.members.size(), 3U);
  other.grid.block.poisson = 0.4;
  EXPECT_FALSE(merge_table(one, other));
}

TEST(DepthTableTest, AMergeThatAddsNothingKeepsTheStatementOfError) {
  DepthTable table = small_table();
  table.checked_count = 60;
  ASSERT_TRUE(merge_table(table, small_table()));
  EXPECT_EQ(table.checked_count, 60U);
  DepthTable more = small_table();
  more.members[0].ratio = 1;
  ASSERT_TRUE(merge_table(table, more));
  EXPECT_EQ(table.checked_count, 0U) << "that was of fewer curves";
}

TEST(DatabaseCommandTest, ADatabaseGivenTwiceIsRefusedAndNothingWritten) {
  const std::string one = test::own_path("depth_table_one.bin");
  const std::string out = test::own_path("depth_table_out.bin");
  std::filesystem::remove(out);
  std::ofstream{one, std::ios::binary} << table_bytes(small_table());
  const auto merged = run_merge({.out = out, .files = {one, one}});
  EXPECT_EQ(merged.code, config::ExitCode::BadInput);
  EXPECT_NE(merged.text.find("given twice"), std::string::npos) << merged.text;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(DatabaseBuilderTest, LeavesOutWhatDoesNotFit) {
  const DepthGrid grid = default_grid();
  const auto cells = cells_of(grid);
  EXPECT_LT(cells.size(), 2 * grid.depths.size() * grid.radii.size());
  for (const GridCell& cell : cells) {
    EXPECT_LT(grid.depths[cell.depth] + 2 * grid.radii[cell.radius], grid.block.height);
  }
  EXPECT_NEAR(indentation_limit(grid, 3e-3), 2.4e-3, 1e-6);
  EXPECT_NEAR(indentation_limit(grid, 20e-3), 5e-3, 1e-12);
}

TEST(DatabaseCommandTest, AFileOfAnotherAccuracyIsNotGoneOnWith) {
  const std::string out = test::own_path("depth_table_normal.bin");
  DepthTable normal = small_table();
  normal.made_by = "accuracy normal";
  std::ofstream{out, std::ios::binary} << table_bytes(normal);
  const auto fine = run_database({.out = out, .accuracy = "fine"});
  EXPECT_EQ(fine.code, config::ExitCode::BadInput);
  EXPECT_NE(fine.text.find("was made by \"accuracy normal\""), std::string::npos) << fine.text;
}

TEST(DatabaseCommandTest, RefusesAShardThatIsNone) {
  EXPECT_EQ(run_database({.shard = "3/2"}).code, config::ExitCode::BadInput);
}

}  // namespace
}  // namespace palp::fem
