#include "review/report_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

namespace palp::review {
namespace {

TEST(ReportFileTest, ReplacesAnOldReportWholeAndLeavesNothingElse) {
  const std::string folder = testing::TempDir() + "palp_report_file_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/report.json";
  ASSERT_FALSE(write_whole(path, "a much longer old text"));
  ASSERT_FALSE(write_whole(path, "new"));
  std::ifstream file{path};
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>{file}, {}), "new");
  const auto entries = std::filesystem::directory_iterator{folder};
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
  std::filesystem::remove_all(folder);
}

TEST(ReportFileTest, FolderThatIsNotThereIsNamed) {
  const auto error = write_whole("/nowhere/report.json", "text");
  ASSERT_TRUE(error);
  EXPECT_NE(error->text.find("/nowhere/report.json"), std::string::npos);
}

}  // namespace
}  // namespace palp::review
