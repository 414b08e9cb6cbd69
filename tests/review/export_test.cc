#include "review/export.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/review/session_samples.h"
#include "tests/support/own_path.h"

namespace palp::review {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ExportTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }
  [[nodiscard]] std::string written() const {
    std::ifstream file{path_, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
  }

  std::string path_ = palp::test::own_path("export");
  test::SampleFiles files_ = test::sample_session({.taps_per_place = 1});
};

TEST_F(ExportTest, CsvHasAColumnForEachFieldWithItsUnit) {
  const auto rows = export_file(files_.surgeon, {.topics = {"surgeon/tick"}}, path_);
  ASSERT_TRUE(rows) << rows.error().text;
  EXPECT_EQ(rows->messages, 2000U);
  EXPECT_EQ(rows->lack, "");
  const std::string text = written();
  EXPECT_THAT(text, StartsWith("t_s,stamp_ns,state,epoch,position_m,velocity_m_per_s,force_n,"));
  EXPECT_THAT(text, HasSubstr("\n0.001000000,1000000,"));
}

TEST_F(ExportTest, AnIntervalIsCutOut) {
  const ExportAsk ask{.topics = {"surgeon/tick"}, .from = 0.5, .to = 0.6};
  const Exported part = export_file(files_.surgeon, ask, path_).value();
  EXPECT_EQ(part.messages, 100U);
  EXPECT_EQ(part.lack, "") << "what was not asked for is not missing";
}

TEST_F(ExportTest, WhatTheFileLacksIsTold) {
  const std::size_t middle = files_.surgeon.size() / 2;
  files_.surgeon[middle] ^= std::byte{4};
  const ExportAsk all{.topics = {"surgeon/tick"}};
  EXPECT_THAT(export_file(files_.surgeon, all, path_).value().lack, HasSubstr("messages"));
  std::filesystem::remove(path_);
  const ExportAsk part{.topics = {"surgeon/tick"}, .from = 0.1, .to = 1.9};
  EXPECT_THAT(export_file(files_.surgeon, part, path_).value().lack, HasSubstr("chunks"));
}

TEST_F(ExportTest, MatHasAVectorForEachColumn) {
  const ExportAsk ask{
      .topics = {"surgeon/tick", "surgeon/link"}, .from = 0, .to = 1, .format = ExportFormat::Mat};
  EXPECT_EQ(export_file(files_.surgeon, ask, path_).value().messages, 1010U);
  const std::string bytes = written();
  std::size_t at = 0;
  std::map<std::string, std::vector<double>> vectors;
  while (at < bytes.size()) {
    std::array<std::int32_t, 5> head{};
    ASSERT_LE(at + sizeof head, bytes.size());
    std::memcpy(head.data(), bytes.data() + at, sizeof head);
    at += sizeof head;
    const std::string name{bytes.data() + at};
    at += static_cast<std::size_t>(head[4]);
    std::vector<double> values(static_cast<std::size_t>(head[1]));
    ASSERT_LE(at + values.size() * sizeof(double), bytes.size());
    std::memcpy(values.data(), bytes.data() + at, values.size() * sizeof(double));
    at += values.size() * sizeof(double);
    vectors[name] = values;
  }
  EXPECT_EQ(vectors["surgeon_tick_position_m"].size(), 1000U);
  EXPECT_EQ(vectors["surgeon_link_round_trip_ns"].size(), 10U);
  EXPECT_EQ(vectors["surgeon_tick_t_s"][999], 0.999);
  EXPECT_EQ(vectors["surgeon_tick_position_m"][400], test::hand_tick(400, 1).position);
}

TEST_F(ExportTest, RefusesWhatIsNotThereAndWritesOverNothing) {
  const auto nothing = export_file(files_.surgeon, {.topics = {"surgeon/hand"}}, path_);
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().text, HasSubstr("surgeon/hand"));
  EXPECT_FALSE(std::filesystem::exists(path_));
  EXPECT_FALSE(export_file(files_.surgeon, {.topics = {"surgeon/tick", "surgeon/link"}}, path_));
  std::ofstream{path_} << "precious";
  EXPECT_FALSE(export_file(files_.surgeon, {.topics = {"surgeon/tick"}}, path_));
  EXPECT_EQ(written(), "precious");
}

}  // namespace
}  // namespace palp::review
