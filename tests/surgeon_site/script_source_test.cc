#include "surgeon_site/script_source.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surgeon_site/drawn_script.h"
#include "tests/support/own_path.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using testing::AllOf;
using testing::HasSubstr;

TEST(ScriptSourceTest, LoadsByNameAndByFile) {
  const ScriptSetting setting{.hand_stiffness = 300};
  EXPECT_EQ(load_script("script:standard", setting)->length(), 33700ms);
  EXPECT_TRUE(load_script("script:demo", setting));
  EXPECT_TRUE(load_script("script:map", setting));
  const std::string path = test::own_path("script_reader_test.txt");
  std::ofstream{path} << "hold 1\nhold x\n";
  EXPECT_THAT(load_script("script:" + path, setting).error().text,
              AllOf(HasSubstr(path), HasSubstr("line 2")));
  std::ofstream{path} << "t_s,position_mm\n0,-10\n2,-10\n";
  EXPECT_EQ(load_script("replay:" + path, setting)->length(), 2s);
  EXPECT_THAT(load_script("script:/nowhere/x", setting).error().text,
              HasSubstr("cannot read /nowhere/x"));
  EXPECT_THAT(load_script("script:/", setting).error().text, HasSubstr("cannot"));
  EXPECT_EQ(load_script("script:random:7", setting)->length(), drawn_script(7, setting).length());
  for (const char* wrong : {"script:random:", "script:random:x", "script:random:-1"}) {
    EXPECT_THAT(load_script(wrong, setting).error().text, HasSubstr("must be a whole number"));
  }
  EXPECT_THAT(load_script("robot", setting).error().text, HasSubstr("unknown master 'robot'"));
}

}  // namespace
}  // namespace palp::surgeon
