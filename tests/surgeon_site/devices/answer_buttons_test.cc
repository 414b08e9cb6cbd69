#include "surgeon_site/devices/answer_buttons.h"

#include <array>

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

TEST(AnswerButtonsTest, EachButtonIsTheAnswerThatItStandsFor) {
  const AnswerButtons buttons{{9, 2, 0}};
  std::array<std::uint8_t, 2> report{};
  EXPECT_EQ(buttons.held(report), 0);
  report[1] = 0b10;
  EXPECT_EQ(buttons.held(report), 0b001) << "button 9 is the first answer";
  report[0] = 0b101;
  EXPECT_EQ(buttons.held(report), 0b111);
  report[0] = 0b11111010;
  EXPECT_EQ(buttons.held(report), 0b001) << "other buttons are none";
}

TEST(AnswerButtonsTest, WhatTheReportDoesNotHoldIsNotHeld) {
  const std::array<std::uint8_t, 1> report{0xFF};
  EXPECT_EQ((AnswerButtons{{8, 7, 511}}.held(report)), 0b010);
  EXPECT_EQ(AnswerButtons{}.held(report), 0);
}

}  // namespace
}  // namespace palp::surgeon
