#include "netem/relay/client_choice.h"

#include <vector>

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

using std::chrono::milliseconds;

const io::Endpoint kClient = *io::resolve_endpoint("127.0.0.1:1000");
const io::Endpoint kStranger = *io::resolve_endpoint("127.0.0.1:2000");
const std::vector<std::byte> kTelegram(100, std::byte{0x80});
const std::vector<std::byte> kOneByte(1, std::byte{0x80});

TimePoint at(int ms) { return TimePoint{} + std::chrono::hours{1} + milliseconds{ms}; }

TEST(ClientChoiceTest, OneByteDatagramsBesideASessionDivertNothing) {
  ClientChoice choice;
  for (int ms = 0; ms < 5000; ++ms) {
    choice.heard(kClient, kTelegram, at(ms));
    if (ms % 2 == 0) choice.heard(kStranger, kOneByte, at(ms));
    ASSERT_EQ(choice.client(), kClient) << ms;
  }
}

TEST(ClientChoiceTest, OneByteDatagramsInAShortPauseDivertNothing) {
  ClientChoice choice;
  choice.heard(kClient, kTelegram, at(0));
  for (int ms = 1; ms < 50; ++ms) choice.heard(kStranger, kOneByte, at(ms));
  choice.heard(kClient, kTelegram, at(60));
  EXPECT_EQ(choice.client(), kClient);
}

TEST(ClientChoiceTest, ASiteThatMovedIsFollowedWithinTwoWindows) {
  ClientChoice choice;
  for (int ms = 0; ms < 1000; ++ms) choice.heard(kClient, kTelegram, at(ms));
  int ms = 1000;
  while (choice.client() != kStranger && ms < 3000) choice.heard(kStranger, kTelegram, at(ms++));
  EXPECT_LE(at(ms), at(1000) + 2 * ClientChoice::kWindow);
}

TEST(ClientChoiceTest, ARestartedSiteIsFollowedWithItsFirstDatagram) {
  ClientChoice choice;
  choice.heard(kClient, kTelegram, at(0));
  choice.heard(kStranger, kTelegram, at(500));
  EXPECT_EQ(choice.client(), kStranger);
}

TEST(ClientChoiceTest, AnybodyIsFollowedAfterASecondOfSilence) {
  ClientChoice choice;
  choice.heard(kClient, kTelegram, at(0));
  choice.heard(kStranger, kOneByte, at(999));
  EXPECT_EQ(choice.client(), kClient);
  choice.heard(kStranger, kOneByte, at(1000));
  EXPECT_EQ(choice.client(), kStranger);
}

TEST(ClientChoiceTest, ASessionGetsItsWayBackFromASlowerStrangerWithinTwoWindows) {
  ClientChoice choice;
  choice.heard(kClient, kTelegram, at(0));
  int ms = 1500;
  choice.heard(kStranger, kTelegram, at(ms));
  ASSERT_EQ(choice.client(), kStranger) << "the client had a pause";
  while (choice.client() != kClient && ms < 3000) {
    choice.heard(kClient, kTelegram, at(ms));
    if (ms % 2 == 0) choice.heard(kStranger, kTelegram, at(ms));
    ++ms;
  }
  EXPECT_LE(at(ms), at(1500) + 2 * ClientChoice::kWindow);
}

TEST(ClientChoiceTest, ManyStrangersTogetherDoNotOutdoTheClient) {
  ClientChoice choice;
  for (int ms = 0; ms < 2000; ++ms) {
    choice.heard(kClient, kTelegram, at(ms));
    for (int i = 0; i < 3; ++i) {
      const auto port = std::to_string(3000 + (3 * ms + i) % 97);
      choice.heard(*io::resolve_endpoint("127.0.0.1:" + port), kTelegram, at(ms));
    }
    ASSERT_EQ(choice.client(), kClient) << ms;
  }
}

}  // namespace
}  // namespace palp::netem
