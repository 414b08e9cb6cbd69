#include "common/plot/picture.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "common/core/whole_file.h"
#include "tests/support/own_path.h"

namespace palp::plot {
namespace {

const Figure kFigure{.panels = {{.axes = {.x_name = "x [m]"}, .curves = {}}}};

TEST(PictureTest, EveryFileThatWasAskedForIsWritten) {
  const PictureFlags flags{
      .svg = test::own_path("both.svg"), .pdf = test::own_path("both.pdf"), .style = "single"};
  ASSERT_TRUE(write_picture(kFigure, flags));
  const auto svg = read_whole_file(flags.svg);
  ASSERT_TRUE(svg);
  EXPECT_EQ(*svg, figure_svg(kFigure, *style_of("single")));
  const auto pdf = read_whole_file(flags.pdf);
  ASSERT_TRUE(pdf);
  EXPECT_TRUE(pdf->starts_with("%PDF-"));
}

TEST(PictureTest, NothingIsAskedForAndNothingIsWritten) {
  EXPECT_FALSE(PictureFlags{}.asked());
  EXPECT_TRUE(can_write_picture({}));
  EXPECT_TRUE(write_picture(kFigure, {}));
}

TEST(PictureTest, WhatCannotBeWrittenIsToldBeforehandAndLeavesNothing) {
  for (const PictureFlags& flags :
       {PictureFlags{.svg = "/no/such/folder/p"}, PictureFlags{.pdf = "/no/such/folder/p"}}) {
    EXPECT_TRUE(flags.asked());
    EXPECT_FALSE(can_write_picture(flags));
    EXPECT_FALSE(write_picture(kFigure, flags));
  }
  EXPECT_TRUE(
      can_write_picture({.svg = test::own_path("none.svg"), .pdf = test::own_path("none.pdf")}));
  EXPECT_FALSE(std::filesystem::exists(test::own_path("none.svg")));
  EXPECT_FALSE(std::filesystem::exists(test::own_path("none.pdf")));
}

TEST(PictureTest, APdfThatNobodyCanMakeIsToldBeforehand) {
  const std::string path = std::getenv("PATH");
  ASSERT_EQ(setenv("PATH", "/no/such/folder", 1), 0);
  const auto can = can_write_picture({.pdf = test::own_path("none.pdf")});
  ASSERT_EQ(setenv("PATH", path.c_str(), 1), 0);
  ASSERT_FALSE(can);
  EXPECT_TRUE(can.error().unreachable);
  EXPECT_NE(can.error().text.find("librsvg2-bin"), std::string::npos) << can.error().text;
}

TEST(PictureTest, TheFlagsOfAVerbAreDeclaredInOnePlace) {
  config::CommandLine line{"palp-test", "for a test"};
  PictureFlags flags;
  declare_picture(line, flags, "a picture");
  const char* const given[]{"palp-test", "--svg", "a", "--pdf=b", "--style", "double"};
  EXPECT_FALSE(line.parse(6, given));
  EXPECT_EQ(flags.svg + flags.pdf + flags.style, "abdouble");
  config::CommandLine other{"palp-test", "for a test"};
  declare_picture(other, flags, "a picture");
  const char* const wrong[]{"palp-test", "--style", "triple"};
  const auto refused = other.parse(3, wrong);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, config::ExitCode::BadInput);
}

}  // namespace
}  // namespace palp::plot
