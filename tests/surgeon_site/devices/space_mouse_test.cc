#include "surgeon_site/devices/space_mouse.h"

#include <gtest/gtest.h>

#include "tests/surgeon_site/devices/hid_bench.h"

namespace palp::surgeon {
namespace {

using fake_hid::Bytes;
using fake_hid::bytes_of;

MasterInstallation built_in() {
  MasterInstallation made;
  made.position_unit = SpaceMouse::kPositionUnit;
  return made;
}

class SpaceMouseTest : public testing::Test {
 protected:
  SpaceMouseTest()
      : bench_{std::make_unique<SpaceMouse>(SpaceMouse::Rates{}, AnswerButtons{{1, 8}}),
               SpaceMouse::addresses()[0],
               built_in()} {
    fake_hid::Device made;
    made.path = "cap";
    made.vendor = 0x256F;
    made.product = 0xC635;
    made.usage_page = 1;
    raw_ = &fake_hid::plug(made);
    (void)bench_.step();
  }
  MasterReading run_for_ms(int span, const Bytes& report = {}) {
    MasterReading reading;
    for (int i = 0; i < span; ++i) {
      if (!report.empty() && i % 10 == 0) raw_->input.push_back(report);
      reading = bench_.step(2);
    }
    return reading;
  }
  MasterBench bench_;
  fake_hid::Device* raw_{};
};

// x 0, y 0, z 350: full deflection downwards.
const char* const kDown = "01 00 00 00 00 5E 01";

TEST_F(SpaceMouseTest, AtRestItSaysNothingAndStandsWhereItBegan) {
  const MasterReading reading = run_for_ms(1000);
  EXPECT_EQ(reading.state, MasterState::Ready);
  EXPECT_EQ(reading.position, -10e-3);
  EXPECT_EQ(reading.velocity, 0);
}

// A press counts once, however long it lasts; a pedal is no answer.
TEST_F(SpaceMouseTest, ItsOtherButtonsAnswer) {
  MasterReading reading = run_for_ms(30, bytes_of("03 01 00 00 00 00 00"));
  EXPECT_TRUE(reading.pedal_held);
  EXPECT_EQ(reading.answers, 0U);
  reading = run_for_ms(30, bytes_of("03 03 00 00 00 00 00"));
  EXPECT_TRUE(reading.pedal_held);
  EXPECT_EQ(reading.answers, 1U);
  EXPECT_EQ(reading.answer, 1U);
  reading = run_for_ms(30, bytes_of("03 00 00 00 00 00 00"));
  EXPECT_EQ(reading.answers, 1U) << "letting go is no answer";
  reading = run_for_ms(30, bytes_of("03 00 01 00 00 00 00"));
  EXPECT_EQ(reading.answers, 2U);
  EXPECT_EQ(reading.answer, 2U);
}

TEST_F(SpaceMouseTest, FullyDeflectedItGoesAtItsRate) {
  const MasterReading reading = run_for_ms(200, bytes_of(kDown));
  EXPECT_EQ(reading.state, MasterState::Ready);
  EXPECT_NEAR(reading.position, -10e-3 + 0.2 * 20e-3, 0.1e-3);
  EXPECT_NEAR(reading.velocity, 20e-3, 1e-9);
  EXPECT_EQ(reading.force, 0) << "it has no motor";
  EXPECT_TRUE(raw_->written.empty());
}

TEST_F(SpaceMouseTest, SilentWhileDeflectedItStandsAfterATenthOfASecond) {
  (void)run_for_ms(50, bytes_of(kDown));
  const double before = run_for_ms(120).position;
  const MasterReading later = run_for_ms(300);
  EXPECT_EQ(later.position, before);
  EXPECT_EQ(later.velocity, 0);
  EXPECT_EQ(later.state, MasterState::Ready) << "silence is no fault of a cap";
}

TEST_F(SpaceMouseTest, ATouchIsNoMotion) {
  const MasterReading reading = run_for_ms(500, bytes_of("01 10 00 10 00 10 00"));
  EXPECT_EQ(reading.velocity, 0);
  EXPECT_EQ(reading.place.x, 0);
}

TEST_F(SpaceMouseTest, SixAxesInOneReportAndButtons) {
  (void)run_for_ms(100, bytes_of("01 5E 01 5E 01 00 00 00 00 00 00 00 00"));
  raw_->input.push_back(bytes_of("03 01 00"));
  const MasterReading reading = bench_.step();
  EXPECT_NEAR(reading.place.x, 5e-3, 0.1e-3);
  EXPECT_NEAR(reading.place.y, -5e-3, 0.1e-3);
  EXPECT_TRUE(reading.pedal_held);
  raw_->input.push_back(bytes_of("02 5E 01 00 00 00 00"));
  raw_->input.push_back(bytes_of("09 01"));
  EXPECT_EQ(bench_.step().broken, 1U);
}

TEST_F(SpaceMouseTest, StaysWithinItsTravel) {
  EXPECT_DOUBLE_EQ(run_for_ms(2000, bytes_of(kDown)).position, 20e-3);
}

TEST_F(SpaceMouseTest, UnpluggedItIsAbsent) {
  (void)run_for_ms(50, bytes_of(kDown));
  raw_->there = false;
  EXPECT_EQ(bench_.step().state, MasterState::Absent);
}

}  // namespace
}  // namespace palp::surgeon
