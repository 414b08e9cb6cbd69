#include "common/record/file_bytes.h"

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "common/record/mapped_file.h"
#include "tests/support/own_path.h"

namespace palp::record {
namespace {

TEST(FileBytesTest, WhatWasForgottenIsThereAgainWhenItIsLookedAt) {
  const std::string path = test::own_path("file_bytes");
  std::FILE* const out = std::fopen(path.c_str(), "wb");
  ASSERT_NE(out, nullptr);
  for (int k = 0; k < 100'000; ++k) (void)std::fputc(k % 251, out);
  (void)std::fclose(out);
  const auto file = MappedFile::open(path);
  (void)std::remove(path.c_str());
  ASSERT_TRUE(file);
  const std::span<const std::byte> bytes = file->bytes();
  EXPECT_EQ(bytes[50'000], std::byte{50'000 % 251});
  file->bytes().forget(0, 90'000);
  EXPECT_EQ(bytes[50'000], std::byte{50'000 % 251});
  file->bytes().forget(0, 1'000'000);
  EXPECT_EQ(bytes[99'999], std::byte{99'999 % 251});
}

TEST(FileBytesTest, BytesInMemoryAreNeverForgotten) {
  const std::vector<std::byte> memory(100'000, std::byte{7});
  FileBytes{memory}.forget(0, memory.size());
  EXPECT_EQ(memory[50'000], std::byte{7});
}

}  // namespace
}  // namespace palp::record
