#include "review/info.h"

#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

TEST(InfoTest, TellsDurationTopicsRatesDropsAndEnd) {
  const std::string text = describe(test::sample_session().surgeon);
  EXPECT_NE(text.find("surgeon/tick_view"), std::string::npos);
  EXPECT_NE(text.find("1000.0"), std::string::npos) << text;
  EXPECT_NE(text.find("5.999 s"), std::string::npos) << text;
  EXPECT_NE(text.find("dropped 0"), std::string::npos) << text;
  EXPECT_NE(text.find("closed in order"), std::string::npos) << text;
}

TEST(InfoTest, TellsHowFarACutOffFileGoes) {
  auto file = test::sample_session().surgeon;
  file.resize(file.size() / 2);
  const std::string text = describe(file);
  EXPECT_NE(text.find("the file was not closed"), std::string::npos) << text;
  EXPECT_NE(text.find("last at 2.999"), std::string::npos) << text;
}

TEST(InfoTest, EmptyFileIsNoTrouble) {
  EXPECT_NE(describe({}).find("the file was not closed"), std::string::npos);
}

}  // namespace
}  // namespace palp::review
