#include "common/record/byte_sink.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/record/mapped_file.h"

namespace palp::record {
namespace {

class FileTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_{testing::TempDir() + "palp_byte_sink_" + std::to_string(::getpid())};
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
  EXPECT_TRUE(std::ranges::equal(file->bytes(), std::as_bytes(std::span{kText})));
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
  EXPECT_FALSE(MappedFile::open(testing::TempDir()));
}

}  // namespace
}  // namespace palp::record
