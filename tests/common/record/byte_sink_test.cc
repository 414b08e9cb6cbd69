#include "common/record/byte_sink.h"

#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/record/mapped_file.h"
#include "tests/support/own_path.h"

namespace palp::record {
namespace {

class FileTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_{test::own_path("byte_sink")};
};

constexpr std::string_view kText{"some bytes"};

TEST_F(FileTest, WhatIsWrittenIsReadBack) {
  {
    auto sink = FileSink::create(path_);
    ASSERT_TRUE(sink);
    EXPECT_TRUE(sink->write(std::as_bytes(std::span{kText})));
  }
  const auto file = MappedFile::open(path_);
  ASSERT_TRUE(file);
  EXPECT_TRUE(std::ranges::equal(std::span<const std::byte>{file->bytes()},
                                 std::as_bytes(std::span{kText})));
}

TEST_F(FileTest, ExistingFileIsNotOverwritten) {
  ASSERT_TRUE(FileSink::create(path_));
  const auto again = FileSink::create(path_);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().text.find(path_), std::string::npos);
}

TEST_F(FileTest, EmptyFileAndDirectoryAndNothingAreToldApart) {
  EXPECT_FALSE(MappedFile::open(path_));
  ASSERT_TRUE(FileSink::create(path_));
  const auto empty = MappedFile::open(path_);
  ASSERT_TRUE(empty);
  EXPECT_TRUE(empty->bytes().empty());
  EXPECT_FALSE(MappedFile::open("/"));
  std::filesystem::remove(path_);
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  EXPECT_FALSE(MappedFile::open(path_)) << "a pipe, whose writer is not waited for";
}

TEST_F(FileTest, OnlyTheOwnerMayRead) {
  const ::mode_t before = ::umask(0);
  const auto sink = FileSink::create(path_);
  ::umask(before);
  ASSERT_TRUE(sink);
  EXPECT_EQ(std::filesystem::status(path_).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

/// No file of this process grows beyond `size` [bytes] while it lives: a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(::rlim_t size) {
    (void)std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{size, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(FileTest, AFullDiskIsAFaultAndLeavesWholePieces) {
  auto sink = FileSink::create(path_);
  ASSERT_TRUE(sink);
  const auto piece = std::as_bytes(std::span{kText});
  {
    const FullDisk full{25};
    EXPECT_TRUE(sink->write(piece));
    EXPECT_TRUE(sink->fault().empty());
    EXPECT_TRUE(sink->write(piece));
    EXPECT_FALSE(sink->write(piece));
  }
  EXPECT_NE(sink->fault().find(path_), std::string::npos);
  EXPECT_FALSE(sink->write(piece)) << "a file with a hole is worse than a short one";
  EXPECT_EQ(std::filesystem::file_size(path_), 2 * piece.size());
}

TEST_F(FileTest, ARemovedFileIsNoticedAndTakesNothingMore) {
  auto sink = FileSink::create(path_);
  ASSERT_TRUE(sink);
  sink->look();
  EXPECT_TRUE(sink->fault().empty());
  std::filesystem::remove(path_);
  sink->look();
  EXPECT_TRUE(sink->removed());
  EXPECT_FALSE(sink->write(std::as_bytes(std::span{kText})));
}

TEST_F(FileTest, AReplacedFileIsNoticedAlsoAtTheLastMoment) {
  auto sink = FileSink::create(path_);
  ASSERT_TRUE(sink);
  const std::string elsewhere = path_ + "_moved";
  std::filesystem::rename(path_, elsewhere);
  ASSERT_TRUE(FileSink::create(path_));
  sink->finish();
  EXPECT_NE(sink->fault().find("moved or replaced"), std::string::npos);
  EXPECT_FALSE(sink->removed());
  EXPECT_TRUE(sink->write(std::as_bytes(std::span{kText}))) << "the moved one is still whole";
  std::filesystem::remove(elsewhere);
}

TEST_F(FileTest, AFileThatIsCutShortIsNoticed) {
  auto sink = FileSink::create(path_);
  ASSERT_TRUE(sink);
  ASSERT_TRUE(sink->write(std::as_bytes(std::span{kText})));
  sink->look();
  EXPECT_TRUE(sink->fault().empty());
  std::filesystem::resize_file(path_, 1);
  sink->look();
  EXPECT_NE(sink->fault().find("cut short"), std::string::npos);
}

TEST_F(FileTest, TheRoomIsThatOfItsDisk) {
  const auto sink = FileSink::create(path_);
  ASSERT_TRUE(sink);
  const auto room = sink->room();
  ASSERT_TRUE(room);
  EXPECT_LE(*room, std::filesystem::space(path_).capacity);
}

}  // namespace
}  // namespace palp::record
