#include "review/plot_command.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "common/core/whole_file.h"
#include "tests/review/session_samples.h"
#include "tests/support/own_path.h"

namespace palp::review {
namespace {

class PlotCommandTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    const auto files = test::sample_session();
    save(flags_.sessions.surgeon, files.surgeon);
    save(flags_.sessions.patient, files.patient);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  static void save(const std::string& path, std::span<const std::byte> bytes) {
    std::ofstream file{path, std::ios::binary};
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

  std::string folder_ = palp::test::own_path("plot");
  PlotFlags flags_{.sessions = {.surgeon = folder_ + "/s.mcap", .patient = folder_ + "/p.mcap"},
                   .picture = {.svg = folder_ + "/p.svg"}};
};

TEST_F(PlotCommandTest, DrawsASessionFromItsFiles) {
  const auto status = run_plot(flags_);
  ASSERT_EQ(status.code, config::ExitCode::Done) << status.text;
  const auto svg = read_whole_file(flags_.picture.svg);
  ASSERT_TRUE(svg);
  for (const char* words : {">felt by the hand<", ">touched by the tip<", ">time [s]<"}) {
    EXPECT_NE(svg->find(words), std::string::npos) << words;
  }
}

TEST_F(PlotCommandTest, RefusesWhatNobodyCouldSee) {
  PlotFlags none = flags_;
  none.picture.svg.clear();
  EXPECT_EQ(run_plot(none).code, config::ExitCode::BadInput) << "no picture";
  PlotFlags late = flags_;
  late.from = 1e6;
  EXPECT_EQ(run_plot(late).code, config::ExitCode::BadInput) << "no tick";
  EXPECT_FALSE(std::filesystem::exists(flags_.picture.svg));
}

TEST_F(PlotCommandTest, WhatCannotBeReadOrWrittenIsNamed) {
  PlotFlags closed = flags_;
  closed.picture.svg = "/no/such/folder/p.svg";
  const auto status = run_plot(closed);
  EXPECT_EQ(status.code, config::ExitCode::CannotOpen);
  EXPECT_NE(status.text.find("/no/such/folder"), std::string::npos) << status.text;
  std::swap(flags_.sessions.surgeon, flags_.sessions.patient);
  EXPECT_EQ(run_plot(flags_).code, config::ExitCode::BadInput) << "the other site's file";
}

}  // namespace
}  // namespace palp::review
