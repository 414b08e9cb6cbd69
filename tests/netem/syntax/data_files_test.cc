#include "netem/syntax/data_files.h"

#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/own_path.h"

namespace palp::netem {
namespace {

TEST(DataFilesTest, ReadsAFileByItsPathAndSaysWhichIsMissing) {
  const std::string path = test::own_path("data_files_test.csv");
  std::ofstream{path} << "t_ms,delay_ms\n";
  const auto text = read_data_file(path);
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, "t_ms,delay_ms\n");
  std::remove(path.c_str());
  const auto missing = read_data_file("no such trace.csv");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().text.find("'no such trace.csv'"), std::string::npos);
  EXPECT_FALSE(read_data_file("/dev/null")) << "a device is no file of data";
}

}  // namespace
}  // namespace palp::netem
