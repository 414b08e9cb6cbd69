#include "video/media_seal.h"

#include <gtest/gtest.h>

#include "common/link/aead_protection.h"

namespace palp::video {
namespace {

link::AeadKey key_of(std::uint8_t seed) {
  std::array<std::byte, 76> bytes{};
  bytes.fill(std::byte{seed});
  const std::span<const std::byte, 76> all{bytes};
  return {.key = link::Secret<32>{all.subspan<0, 32>()},
          .salt = link::Secret<12>{all.subspan<32, 12>()},
          .header_key = link::Secret<32>{all.subspan<44, 32>()}};
}

MediaSeal site(std::uint8_t sends, std::uint8_t receives) {
  return MediaSeal{{.protection = std::make_unique<link::AeadProtection>(
                        link::TrafficKeys{.send = key_of(sends), .receive = key_of(receives)}),
                    .send_connection = sends,
                    .receive_connection = receives}};
}

const Bytes kPayload(500, std::byte{42});

TEST(MediaSealTest, OpensWhatThePeerSealedOnce) {
  MediaSeal patient = site(1, 2);
  MediaSeal surgeon = site(2, 1);
  const Bytes datagram = patient.seal(kPayload);
  EXPECT_EQ(datagram.size(), 16U + 500U + 16U);
  const auto opened = surgeon.open(datagram);
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->payload, kPayload);
  EXPECT_TRUE(opened->newest);
  EXPECT_FALSE(surgeon.open(datagram)) << "replayed";
  EXPECT_EQ(surgeon.refused(), 1U);
}

TEST(MediaSealTest, RefusesWhatWasChangedAnywhere) {
  MediaSeal patient = site(1, 2);
  MediaSeal surgeon = site(2, 1);
  const Bytes datagram = patient.seal(kPayload);
  for (std::size_t i = 0; i < datagram.size(); ++i) {
    Bytes changed = datagram;
    changed[i] ^= std::byte{1};
    EXPECT_FALSE(surgeon.open(changed)) << "byte " << i;
  }
  EXPECT_TRUE(surgeon.open(datagram)) << "what was forged has left no trace";
}

TEST(MediaSealTest, SaysWhichOneIsNewerThanAllBefore) {
  MediaSeal patient = site(1, 2);
  MediaSeal surgeon = site(2, 1);
  const Bytes first = patient.seal(kPayload);
  const Bytes second = patient.seal(kPayload);
  EXPECT_TRUE(surgeon.open(second)->newest);
  EXPECT_FALSE(surgeon.open(first)->newest);
}

TEST(MediaSealTest, TheirOwnDatagramsComeBackToNobody) {
  MediaSeal patient = site(1, 2);
  EXPECT_FALSE(patient.open(patient.seal(kPayload)));
}

}  // namespace
}  // namespace palp::video
