#include "common/config/report.h"

#include <cmath>
#include <filesystem>
#include <limits>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/config/settings_text.h"
#include "common/core/whole_file.h"
#include "tests/support/own_path.h"

namespace palp::config {
namespace {

/// A folder of its own, removed at the end.
class ReportTest : public testing::Test {
 protected:
  ReportTest() { std::filesystem::create_directories(folder_); }
  ~ReportTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] std::size_t file_count() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator{folder_}) {
      ++count;
    }
    return count;
  }

 private:
  std::filesystem::path folder_{test::own_path("report")};
};

TEST_F(ReportTest, WritesWholeFilesAndLeavesNothingElse) {
  ASSERT_TRUE(write_whole_file(path("a.json"), "{}\n"));
  ASSERT_TRUE(write_whole_file(path("a.json"), "{\"schema\": 1}\n"));
  EXPECT_EQ(read_whole_file(path("a.json")), "{\"schema\": 1}\n");
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(ReportTest, SaysBeforehandWhetherAFileCanBeWrittenAndLeavesNothing) {
  EXPECT_TRUE(can_write_file(path("new")));
  EXPECT_EQ(file_count(), 0U);
  ASSERT_TRUE(write_whole_file(path("old"), "old"));
  EXPECT_TRUE(can_write_file(path("old")));
  EXPECT_EQ(read_whole_file(path("old")), "old");
  EXPECT_EQ(file_count(), 1U);
  EXPECT_TRUE(can_write_file("/dev/null"));
  EXPECT_FALSE(can_write_file(path("no/such/folder")));
  EXPECT_FALSE(can_write_file(path("")));
}

// Who laid a file at the temporary name would own what is written, and could read and change it.
TEST_F(ReportTest, WhatSomebodyLaidAtTheTemporaryNameIsNotWrittenTo) {
  const std::string laid = path("a.json.partial." + std::to_string(::getpid()));
  const int held = ::open(laid.c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_GE(held, 0);
  ASSERT_TRUE(write_whole_file(path("a.json"), "secret"));
  struct stat old {};
  struct stat now {};
  ASSERT_EQ(::fstat(held, &old), 0);
  ASSERT_EQ(::stat(path("a.json").c_str(), &now), 0);
  EXPECT_EQ(old.st_size, 0);
  EXPECT_NE(old.st_ino, now.st_ino);
  ::close(held);
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(ReportTest, AReaderOfTheOldFileKeepsIt) {
  ASSERT_TRUE(write_whole_file(path("a.json"), "old"));
  std::filesystem::create_hard_link(path("a.json"), path("held"));
  ASSERT_TRUE(write_whole_file(path("a.json"), "new"));
  EXPECT_EQ(read_whole_file(path("held")), "old");  // replaced by renaming, not overwritten
}

TEST_F(ReportTest, AFileKeepsItsRights) {
  ASSERT_TRUE(write_whole_file(path("secret"), "old"));
  ASSERT_EQ(::chmod(path("secret").c_str(), 0600), 0);
  ASSERT_TRUE(write_whole_file(path("secret"), "new"));
  struct stat there {};
  ASSERT_EQ(::stat(path("secret").c_str(), &there), 0);
  EXPECT_EQ(there.st_mode & 0777U, 0600U);
}

TEST_F(ReportTest, AFileThatNobodyMayWriteToStays) {
  ASSERT_TRUE(write_whole_file(path("kept"), "old"));
  ASSERT_EQ(::chmod(path("kept").c_str(), 0444), 0);
  EXPECT_FALSE(can_write_file(path("kept")));
  EXPECT_FALSE(write_whole_file(path("kept"), "new"));
  EXPECT_EQ(read_whole_file(path("kept")), "old");
}

TEST_F(ReportTest, ALinkAtTheTemporaryNameIsNotFollowed) {
  const std::string temporary = path("a.json") + ".partial." + std::to_string(::getpid());
  ASSERT_TRUE(write_whole_file(path("victim"), "old"));
  std::filesystem::create_symlink(path("victim"), temporary);
  EXPECT_TRUE(write_whole_file(path("a.json"), "new"));
  EXPECT_EQ(read_whole_file(path("victim")), "old");
  EXPECT_FALSE(std::filesystem::is_symlink(path("a.json")));
}

TEST_F(ReportTest, FollowsALinkInsteadOfReplacingIt) {
  ASSERT_TRUE(write_whole_file(path("real"), "old"));
  std::filesystem::create_symlink("real", path("link"));
  ASSERT_TRUE(write_whole_file(path("link"), "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(read_whole_file(path("real")), "new");
}

TEST_F(ReportTest, WritesIntoDevicesAndPipesWithoutReplacingThem) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const auto read_end = std::filesystem::path{path("pipe")};
  const int reader = ::open(read_end.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(write_whole_file(path("pipe"), "text"));
  char got[8] = {};
  EXPECT_EQ(::read(reader, got, sizeof got), 4);
  (void)::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
}

TEST_F(ReportTest, SaysWhyItCannotWrite) {
  EXPECT_EQ(write_whole_file(path("none/a.json"), "x").error().text,
            "cannot write " + path("none/a.json").substr(0, 80) +
                (path("none/a.json").size() > 80 ? "..." : "") + ": No such file or directory");
  std::filesystem::create_directory(path("folder"));
  EXPECT_FALSE(write_whole_file(path("folder"), "x"));
  EXPECT_FALSE(write_whole_file("", "x"));  // fails in renaming
  EXPECT_FALSE(std::filesystem::exists(".partial." + std::to_string(::getpid())));
  EXPECT_EQ(file_count(), 1U);  // the folder: no partial file stays
}

TEST(JsonNumberTest, WritesNullForWhatIsNotFinite) {
  EXPECT_EQ(json_number(0.1), "0.1");
  EXPECT_EQ(json_number(-3), "-3");
  EXPECT_EQ(json_number(std::nan("")), "null");
  EXPECT_EQ(json_number(std::numeric_limits<double>::infinity()), "null");
}

}  // namespace
}  // namespace palp::config
