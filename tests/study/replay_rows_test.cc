#include "study/replay_rows.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

struct Standing {
  Study study = test::small_study();
  AnswerTable table = table_of(study);
  std::vector<BlockPlan> plans = participant_plan(study, 1);
  [[nodiscard]] Block block() const { return {study, table, plans.front()}; }

  /// Answers as somebody gave them.
  [[nodiscard]] std::vector<TrialRow> rows() const {
    std::vector<TrialRow> out;
    for (Block asked = block(); !asked.done();) {
      TrialRow row{.ask = asked.next(), .condition = "A"};
      row.outcome.chosen = row.ask.number % 3 == 0 ? 1 - row.ask.stronger : row.ask.stronger;
      asked.told(row.yes());
      row.believed_mean = asked.believed(row.ask.track).mean;
      row.believed_sd = asked.believed(row.ask.track).sd;
      out.push_back(row);
    }
    return out;
  }
};

TEST(ReplayRowsTest, MakesTheBlockAgain) {
  const Standing standing;
  const auto rows = standing.rows();
  for (std::size_t count = 0; count <= rows.size(); ++count) {
    Block block = standing.block();
    ASSERT_TRUE(replay_rows(block, std::span{rows}.first(count), "A"));
    ASSERT_EQ(block.done(), count == rows.size());
    if (!block.done()) {
      EXPECT_EQ(block.next().level, rows[count].ask.level);
    }
  }
}

TEST(ReplayRowsTest, NoticesEveryChange) {
  const Standing standing;
  const auto rows = standing.rows();
  const std::size_t last = rows.size() - 1;
  const auto refused = [&](auto change, const std::string& code = "A") {
    auto changed = rows;
    change(changed);
    Block block = standing.block();
    return !replay_rows(block, changed, code);
  };
  EXPECT_TRUE(refused([](auto&) {}, "B"));
  EXPECT_TRUE(refused([&](auto& all) { all[last].ask.level *= 1.01; }));
  EXPECT_TRUE(refused([&](auto& all) { all[last].ask.stronger ^= 1; }));
  EXPECT_TRUE(refused([&](auto& all) { all[last].ask.track ^= 1; }));
  EXPECT_TRUE(refused([&](auto& all) { all[last].ask.kind = TrialKind::Practice; }));
  EXPECT_TRUE(refused([&](auto& all) { all[last].believed_mean += 1e-5; }));
  EXPECT_TRUE(refused([&](auto& all) { all[last].believed_sd += 1e-5; }));
  EXPECT_TRUE(refused([&](auto& all) { all.erase(all.begin()); }));
  EXPECT_TRUE(refused([&](auto& all) { all.push_back(all.back()); }));
}

}  // namespace
}  // namespace palp::study
