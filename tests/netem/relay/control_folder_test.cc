#include "netem/relay/control_folder.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/system/process.h"

namespace palp::netem {
namespace {

namespace fs = std::filesystem;

class ControlFolderTest : public ::testing::Test {
 protected:
  ControlFolderTest() {
    std::ofstream{outside_ + "/secret"} << "secret";
    std::ofstream{inside_ + "/sub/own"} << "own";
  }
  ~ControlFolderTest() override { fs::remove_all(outside_); }
  static ControlFolder open_made(const std::string& path) {
    fs::create_directories(path + "/sub");
    return *ControlFolder::open(path);
  }
  const std::string outside_ = system_test::make_folder("palp-control-folder");
  const std::string inside_ = outside_ + "/inside";
  const ControlFolder folder_ = open_made(inside_);
};

TEST_F(ControlFolderTest, WhatLiesInItIsReadByEitherPath) {
  EXPECT_EQ(*folder_.read("sub/own"), "own");
  EXPECT_EQ(*folder_.read(inside_ + "/sub/own"), "own");
  fs::create_symlink("sub/own", inside_ + "/short");
  EXPECT_EQ(*folder_.read("short"), "own") << "a link that stays inside";
}

TEST_F(ControlFolderTest, NoNameLeadsOut) {
  fs::create_symlink(outside_ + "/secret", inside_ + "/absolute");
  fs::create_symlink("../secret", inside_ + "/relative");
  fs::create_directory_symlink(outside_, inside_ + "/up");
  for (const std::string& name : {outside_ + "/secret",
                                  std::string{"../secret"},
                                  std::string{"sub/../../secret"},
                                  std::string{"absolute"},
                                  std::string{"relative"},
                                  std::string{"up/secret"},
                                  inside_ + "/../secret",
                                  inside_ + "x/../secret"}) {
    EXPECT_FALSE(folder_.read(name)) << name;
    EXPECT_FALSE(folder_.create(name)) << name;
  }
  EXPECT_FALSE(folder_.create("../new"));
  EXPECT_FALSE(folder_.create("up/new"));
  EXPECT_EQ(fs::file_size(outside_ + "/secret"), 6U);
  EXPECT_FALSE(fs::exists(outside_ + "/new"));
}

TEST_F(ControlFolderTest, APipeADeviceAndAFileWithoutEndGiveNothingAndNeverWait) {
  ASSERT_EQ(::mkfifo((inside_ + "/pipe").c_str(), 0600), 0);
  EXPECT_FALSE(folder_.read("pipe"));
  EXPECT_FALSE(folder_.read("sub"));
  const auto kernel = ControlFolder::open("/proc");
  ASSERT_TRUE(kernel);
  EXPECT_EQ(kernel->read("kmsg").value_or(""), "") << "a regular file that says 0 bytes and waits";
  const auto devices = ControlFolder::open("/dev");
  ASSERT_TRUE(devices);
  EXPECT_FALSE(devices->read("zero"));
}

TEST_F(ControlFolderTest, WhatIsThereIsNotWrittenOver) {
  EXPECT_FALSE(folder_.create("sub/own"));
  EXPECT_EQ(*folder_.read("sub/own"), "own");
  ASSERT_TRUE(folder_.create("sub/new"));
  EXPECT_EQ(fs::status(inside_ + "/sub/new").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(ControlFolderTest, WithoutAFolderOnlyWhatComesWithTheProgramsIsRead) {
  const ControlFolder none;
  EXPECT_FALSE(none.read(inside_ + "/sub/own"));
  EXPECT_FALSE(none.create("new"));
  EXPECT_FALSE(ControlFolder::open(outside_ + "/secret")) << "no folder";
}

}  // namespace
}  // namespace palp::netem
