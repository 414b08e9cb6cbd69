#include "patient_site/devices/register_words.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "patient_site/devices/device_profile.h"

namespace palp::patient {
namespace {

using testing::ElementsAre;

TEST(RegisterWordsTest, WordOrderIsThatOfTheMaker) {
  EXPECT_THAT(to_words(3070, WordKind::I32, WordOrder::HighFirst), ElementsAre(0, 3070));
  EXPECT_THAT(to_words(12'345, WordKind::I32, WordOrder::LowFirst), ElementsAre(12'345, 0));
  EXPECT_THAT(to_words(-1000, WordKind::I32, WordOrder::HighFirst), ElementsAre(0xFFFF, 0xFC18));
  EXPECT_THAT(to_words(-500, WordKind::I32, WordOrder::LowFirst), ElementsAre(0xFE0C, 0xFFFF));
  const std::array<std::uint16_t, 2> words{0xFFFF, 0xFFF5};
  EXPECT_EQ(from_words(words, WordKind::I32, WordOrder::HighFirst), -11);
}

TEST(RegisterWordsTest, WhatDoesNotFitIsHeldAtTheRange) {
  EXPECT_EQ(to_words(1e9, WordKind::U16, WordOrder::HighFirst)[0], 0xFFFF);
  EXPECT_EQ(to_words(-1, WordKind::U16, WordOrder::HighFirst)[0], 0);
  EXPECT_EQ(to_words(-1e9, WordKind::I16, WordOrder::HighFirst)[0], 0x8000);
  EXPECT_THAT(to_words(1e99, WordKind::I32, WordOrder::HighFirst), ElementsAre(0x7FFF, 0xFFFF));
  EXPECT_THAT(to_words(std::nan(""), WordKind::I32, WordOrder::HighFirst), ElementsAre(0, 0));
}

TEST(RegisterWordsTest, AFloatMayBeNoNumber) {
  const std::array<std::uint16_t, 2> words{0x7FC0, 0};
  EXPECT_TRUE(std::isnan(from_words(words, WordKind::F32, WordOrder::HighFirst)));
}

RC_GTEST_PROP(RegisterWordsTest, ThereAndBackIsTheSame, ()) {
  const auto value = *rc::gen::arbitrary<std::int32_t>();
  const auto order = *rc::gen::element(WordOrder::HighFirst, WordOrder::LowFirst);
  RC_ASSERT(from_words(to_words(value, WordKind::I32, order), WordKind::I32, order) == value);
  const auto small = static_cast<std::int16_t>(value);
  RC_ASSERT(from_words(to_words(small, WordKind::I16, order), WordKind::I16, order) == small);
  const auto real = static_cast<double>(static_cast<float>(value));
  RC_ASSERT(from_words(to_words(real, WordKind::F32, order), WordKind::F32, order) == real);
}

TEST(ReadWordsTest, KnowsWhatItHolds) {
  const ReadWords words{100, 3};
  EXPECT_TRUE(words.holds(100, 3));
  EXPECT_FALSE(words.holds(99, 1));
  EXPECT_FALSE(words.holds(102, 2));
  EXPECT_FALSE(words.holds(103, 1));
  EXPECT_EQ(words_in(WordKind::F32), 2U);
}

}  // namespace
}  // namespace palp::patient
