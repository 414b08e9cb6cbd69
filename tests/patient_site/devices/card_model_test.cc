#include "patient_site/devices/card_model.h"

#include <gtest/gtest.h>

#include "tests/patient_site/devices/card_bench.h"

namespace palp::patient {
namespace {

using fake_hid::bytes_of;

TEST(CardModelTest, ScansAsTheDataSheetsSay) {
  const auto wide = scan_requests(card_model(CardKind::Usb1608), 0, 0);
  EXPECT_EQ(wide[0], bytes_of("13 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(wide[1], bytes_of("11 00 00 00 00 00 00 00 43 01 04"));
  const auto pair = scan_requests(card_model(CardKind::Usb1208), 3, 1);
  EXPECT_EQ(pair[0], bytes_of("13 01 03 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(pair[1], bytes_of("11 03 03 00 00 00 00 00 43 01 10"));
  const auto single = scan_requests(card_model(CardKind::Usb1208), 3, kSingleEnded);
  EXPECT_EQ(single[0], bytes_of("13 01 0B 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(single[1], bytes_of("11 0B 0B 00 00 00 00 00 43 01 10"));
}

TEST(CardModelTest, TwelveBitsStandInTheUpperBitsOfAWord) {
  const CardModel& model = card_model(CardKind::Usb1208);
  const auto volts = [&](std::uint8_t range, std::uint16_t sample) {
    return volts_of_sample(model, range, {}, sample);
  };
  EXPECT_DOUBLE_EQ(volts(1, 0), 0);
  EXPECT_DOUBLE_EQ(volts(1, 0x7FF0), 10);
  EXPECT_DOUBLE_EQ(volts(0, 0x7FF0), 20);
  EXPECT_DOUBLE_EQ(volts(7, 0x7FF0), 1);
  EXPECT_DOUBLE_EQ(volts(1, 0x0010), 10.0 / 0x7FF);
  EXPECT_DOUBLE_EQ(volts(1, 0xFFF0), -10.0 / 0x7FF);
  EXPECT_DOUBLE_EQ(volts(1, 0x8000), -10.0 * 0x800 / 0x7FF);
  EXPECT_TRUE(at_end(model, 1, 0x7FF0));
  EXPECT_TRUE(at_end(model, 1, 0x8000));
  EXPECT_FALSE(at_end(model, 1, 0x7FE0));
}

TEST(CardModelTest, OneWireAgainstGroundHasElevenBitsAndTwoEnds) {
  const CardModel& model = card_model(CardKind::Usb1208);
  const auto counts = [&](std::uint16_t sample) {
    return volts_of_sample(model, kSingleEnded, {}, sample) * 0x7FF / 10;
  };
  EXPECT_DOUBLE_EQ(counts(0x4000), 0);
  EXPECT_DOUBLE_EQ(counts(0x7FF1), -0x800);
  EXPECT_DOUBLE_EQ(counts(0x7FE1), 0x7FF);
  EXPECT_DOUBLE_EQ(counts(0x7FE0), (0x7FE0 >> 3) - 0x800);
  EXPECT_DOUBLE_EQ(counts(0), -0x800);
}

class SmallCardTest : public CardBench {
 protected:
  SmallCardTest() : CardBench{CardKind::Usb1208} {}
};

TEST_F(SmallCardTest, BeginsAtOnceTaresAndFeels) {
  (void)step();
  EXPECT_EQ(raw_[0]->written[0], bytes_of("12"));
  ASSERT_EQ(raw_[0]->written.size(), 3U) << "its memory holds no calibration";
  EXPECT_EQ(raw_[0]->written[2], bytes_of("11 00 00 00 00 00 00 00 43 01 10"));
  EXPECT_EQ(run(50, 0x0020, 16).state, CardState::Ready);
  const CardReading pressed = run(1, 0x0020 + 0x0660, 16);  // 102 counts of 9.77 mV
  EXPECT_NEAR(pressed.force, 5 * 102 * 20.0 / 0x7FF, 0.05);
  EXPECT_EQ(pressed.lost, 0U) << "its packets come over three interfaces";
}

TEST_F(SmallCardTest, AQuietSensorIsNotStuckAndASaturatedOneIsSeen) {
  (void)run(50, 0x0020, 0);
  EXPECT_EQ(run(500, 0x0020, 0).state, CardState::Ready);
  EXPECT_TRUE(run(1, 0x7FF0, 0).saturated);
}

TEST_F(SmallCardTest, SilenceMakesItAbsent) {
  (void)run(50, 0x0020);
  CardReading reading;
  for (int i = 0; i < 7; ++i) reading = step();
  EXPECT_EQ(reading.why, "it fell silent");
}

}  // namespace
}  // namespace palp::patient
