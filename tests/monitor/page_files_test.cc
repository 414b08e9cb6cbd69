#include "monitor/page_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::monitor {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(PageFilesTest, ThePageNamesItsPartsAndNothingFromElsewhere) {
  const std::string page{page_file("/").text};
  EXPECT_THAT(page, HasSubstr("src=\"/page.js\""));
  EXPECT_THAT(page, HasSubstr("href=\"/style.css\""));
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_GT(page_file("/page.js").text.size(), 10'000U);
  EXPECT_GT(page_file("/style.css").text.size(), 1'000U);
  EXPECT_THAT(std::string{page_file("/licences.txt").text}, HasSubstr("MIT"));
}

TEST(PageFilesTest, ThereIsNoOther) {
  for (const char* path : {"", "/index.html", "//", "/../page.js", "/page.js?x", "/PAGE.JS"}) {
    EXPECT_TRUE(page_file(path).media_type.empty()) << path;
  }
}

}  // namespace
}  // namespace palp::monitor
