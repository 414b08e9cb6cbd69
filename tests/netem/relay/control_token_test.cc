#include "netem/relay/control_token.h"

#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/own_path.h"

namespace palp::netem {
namespace {

namespace fs = std::filesystem;

class ControlTokenTest : public ::testing::Test {
 protected:
  ~ControlTokenTest() override { fs::remove(path_); }
  void write(const std::string& text, fs::perms mode) const {
    std::ofstream{path_} << text;
    fs::permissions(path_, mode);
  }
  static constexpr fs::perms kOwner = fs::perms::owner_read | fs::perms::owner_write;
  const std::string path_ = test::own_path("token");
};

TEST_F(ControlTokenTest, OneIsMadeOnceAndIsItsOwnersOnly) {
  std::set<std::string> all;
  for (int i = 0; i < 20; ++i) {
    fs::remove(path_);
    const auto made = read_or_make_token(path_);
    ASSERT_TRUE(made) << made.error().text;
    EXPECT_EQ(fs::status(path_).permissions(), kOwner);
    EXPECT_EQ(*read_or_make_token(path_), *made) << "and read again";
    EXPECT_TRUE(all.insert(*made).second);
  }
}

TEST_F(ControlTokenTest, WhatOthersMayReadOrIsShortIsRefused) {
  write("0123456789abcdef\n", kOwner | fs::perms::others_read);
  EXPECT_FALSE(read_or_make_token(path_));
  write("0123456789abcdef\n", kOwner);
  EXPECT_EQ(*read_or_make_token(path_), "0123456789abcdef");
  write("0123456789abcde\n", kOwner);
  EXPECT_FALSE(read_or_make_token(path_));
  write("01234567 9abcdef\n", kOwner);
  EXPECT_FALSE(read_or_make_token(path_));
}

TEST_F(ControlTokenTest, OnlyTheWholeTokenIsShown) {
  const std::string token = "0123456789abcdef";
  EXPECT_TRUE(shows_token("{ \"token\" : \"" + token + "\" }\r", token));
  for (std::size_t at = 0; at < token.size(); ++at) {
    std::string other = token;
    other[at] = '~';
    EXPECT_FALSE(shows_token("{\"token\":\"" + other + "\"}", token)) << at;
    EXPECT_FALSE(shows_token("{\"token\":\"" + token.substr(0, at) + "\"}", token)) << at;
  }
  EXPECT_FALSE(shows_token("{\"token\":\"\"}", "")) << "no token admits nobody";
  EXPECT_FALSE(shows_token(token, token));
}

}  // namespace
}  // namespace palp::netem
