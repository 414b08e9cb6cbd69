#include "common/io/net/detour.h"

#include <gtest/gtest.h>

namespace palp::io {
namespace {

using std::chrono::milliseconds;

const Endpoint kHere = *resolve_endpoint("192.0.2.1:1000");
const Endpoint kThere = *resolve_endpoint("192.0.2.2:1000");
const Endpoint kThird = *resolve_endpoint("192.0.2.3:1000");

TimePoint at(int ms) { return TimePoint{milliseconds{ms}}; }

class DetourTest : public testing::Test {
 protected:
  DetourTest() { detour_.begin_tick(at(0)); }
  Detour detour_{kHere};
};

TEST_F(DetourTest, AsLongAsTheStraightWayDeliversNothingIsTakenFromElsewhereOrSentThere) {
  detour_.heard(kThere, 100);
  for (int ms = 0; ms < 1000; ++ms) {
    if (ms % 9 == 0) detour_.heard_straight(at(ms));
    EXPECT_NE(detour_.fate(kThere, at(ms), at(ms)), Detour::Fate::Take);
    EXPECT_EQ(detour_.spend(0, 50, at(ms)), nullptr);
  }
}

TEST_F(DetourTest, WhatCameFromElsewhereWaitsUntilTheStraightWayIsSilentAndIsDroppedIfItIsNot) {
  detour_.heard_straight(at(5));
  EXPECT_EQ(detour_.fate(kThere, at(6), at(7)), Detour::Fate::Wait);
  EXPECT_EQ(detour_.fate(kThere, at(6), at(15)), Detour::Fate::Take);
  detour_.heard_straight(at(15));
  EXPECT_EQ(detour_.fate(kThere, at(6), at(17)), Detour::Fate::Drop);
}

TEST_F(DetourTest, NoPlaceGetsMoreThanTwoBytesForEachThatCameFromThere) {
  std::size_t sent = 0;
  detour_.heard(kThere, 300);
  detour_.heard(kThird, 10);
  for (int i = 0; i < 100; ++i) {
    for (std::size_t place = 0; place < Detour::kPlaces; ++place) {
      const Endpoint* to = detour_.spend(place, 50, at(20));
      if (to == nullptr) continue;
      EXPECT_TRUE(*to == kThere) << "20 bytes are not enough for 50";
      sent += 50;
    }
  }
  EXPECT_EQ(sent, 600U);
}

TEST_F(DetourTest, TheAddressThatWasLeftIsHeardAndToldEverythingIfItDelivers) {
  detour_.heard_straight(at(1));
  EXPECT_EQ(detour_.fate(kHere, at(1), at(1)), Detour::Fate::Take);
  detour_.heard(kHere, 100);
  const Endpoint* to = detour_.spend(0, 100, at(1));
  ASSERT_NE(to, nullptr);
  EXPECT_TRUE(*to == kHere);
}

}  // namespace
}  // namespace palp::io
