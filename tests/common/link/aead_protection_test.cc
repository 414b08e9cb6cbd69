#include "common/link/aead_protection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/common/link/some_keys.h"
#include "tests/common/link/whole_open.h"

namespace palp::link {
namespace {

using Bytes = std::vector<std::byte>;
using Lead = AeadProtection::Lead;

Bytes sealed(PacketProtection& protection, const Header& header, std::span<const std::byte> plain) {
  Bytes out(2000);
  out.resize(protection.seal(header, plain, out));
  return out;
}

/// Two ends that went through the same handshake.
struct Ends {
  AeadProtection surgeon{some_keys(1, Role::Surgeon).data};
  AeadProtection patient{some_keys(1, Role::Patient).data};
  Bytes room = Bytes(2000);

  tl::expected<std::size_t, Rejection> at_patient(std::span<const std::byte> datagram) {
    return whole_open(patient, datagram, room);
  }
};

RC_GTEST_PROP(AeadProtectionTest, OpensWhatThePeerSealed, (std::uint32_t number)) {
  const auto content =
      *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::arbitrary<std::uint8_t>());
  const auto plain = std::as_bytes(std::span{content});
  Ends ends;
  const Bytes datagram = sealed(ends.surgeon, {.connection = 7, .number = number}, plain);
  RC_ASSERT(datagram.size() == kHeaderSize + plain.size() + AeadProtection::kTagSize);
  const auto header = ends.patient.read_header(datagram);
  RC_ASSERT(header.has_value());
  RC_ASSERT(header->number == number);
  RC_ASSERT(header->connection == 7U);
  const auto size = ends.at_patient(datagram);
  RC_ASSERT(size.has_value());
  RC_ASSERT(std::ranges::equal(plain, std::span{ends.room}.first(*size)));
}

// NIST's vector for an all-zero key and nonce (GCM specification, test case 14): it holds us to the
// algorithm, where a round trip alone would accept any.
TEST(AeadProtectionTest, IsAes256GcmOfThePublishedVector) {
  TrafficKeys keys;  // all 0; number 0: nonce 0
  AeadProtection protection{keys};
  const std::array<std::byte, 16> plain{};
  const Bytes datagram = sealed(protection, {}, plain);
  const std::array<std::uint8_t, 16> cipher_text{0xce,
                                                 0xa7,
                                                 0x40,
                                                 0x3d,
                                                 0x4d,
                                                 0x60,
                                                 0x6b,
                                                 0x6e,
                                                 0x07,
                                                 0x4e,
                                                 0xc5,
                                                 0xd3,
                                                 0xba,
                                                 0xf3,
                                                 0x9d,
                                                 0x18};
  EXPECT_TRUE(std::ranges::equal(std::span{datagram}.subspan(kHeaderSize, 16),
                                 std::as_bytes(std::span{cipher_text})));
}

TEST(AeadProtectionTest, EverySingleFlippedBitIsRefused) {
  Ends ends;
  const Bytes plain(40, std::byte{0x31});
  const Bytes datagram = sealed(ends.surgeon, {.connection = 7, .number = 5}, plain);
  for (std::size_t bit = 0; bit < 8 * datagram.size(); ++bit) {
    Bytes spoiled = datagram;
    spoiled[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    EXPECT_FALSE(ends.at_patient(spoiled)) << "bit " << bit;
  }
  EXPECT_TRUE(ends.at_patient(datagram)) << "what was refused has changed nothing";
}

TEST(AeadProtectionTest, EveryTruncationAndEveryGluedByteIsRefused) {
  Ends ends;
  const Bytes plain(40, std::byte{0x31});
  const Bytes datagram = sealed(ends.surgeon, {.connection = 7, .number = 5}, plain);
  for (std::size_t size = 0; size < datagram.size(); ++size) {
    EXPECT_FALSE(ends.at_patient(std::span{datagram}.first(size))) << size << " bytes";
    Bytes honest{datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(size)};
    if (size < kHeaderSize) continue;
    const auto length = static_cast<std::uint16_t>(size - kHeaderSize);  // a length that fits
    honest[2] = static_cast<std::byte>(length >> 8U);
    honest[3] = static_cast<std::byte>(length & 0xFFU);
    EXPECT_FALSE(ends.at_patient(honest)) << size << " bytes with their length";
  }
  Bytes glued = datagram;
  glued.insert(glued.end(), datagram.begin(), datagram.end());
  EXPECT_FALSE(ends.at_patient(glued));
}

TEST(AeadProtectionTest, OwnWordsSentBackAreRefused) {
  Ends ends;
  const Bytes datagram = sealed(ends.patient, {.number = 5}, Bytes(20));
  EXPECT_FALSE(ends.at_patient(datagram));
}

TEST(AeadProtectionTest, TheOtherPlaneIsRefused) {
  AeadProtection control{some_keys(1, Role::Surgeon).control};
  Ends ends;
  EXPECT_FALSE(ends.at_patient(sealed(control, {.number = 5}, Bytes(20))));
}

TEST(AeadProtectionTest, AnotherHandshakeIsRefused) {
  AeadProtection before{some_keys(2, Role::Surgeon).data};
  Ends ends;
  EXPECT_FALSE(ends.at_patient(sealed(before, {.number = 5}, Bytes(20))));
}

TEST(AeadProtectionTest, TheSamePlainTextNeverLooksTheSame) {
  Ends ends;
  const Bytes plain(40, std::byte{0x31});
  Bytes first = sealed(ends.surgeon, {.number = 5}, plain);
  Bytes second = sealed(ends.surgeon, {.number = 6}, plain);
  // Without the tags, which differ anyway because the headers do.
  EXPECT_FALSE(std::ranges::equal(std::span{first}.subspan(kHeaderSize, plain.size()),
                                  std::span{second}.subspan(kHeaderSize, plain.size())));
  for (const Bytes& one : {first, second}) {
    EXPECT_FALSE(std::ranges::search(one, std::span{plain}.first(4)).begin() != one.end());
  }
}

/// How many bits of the hidden part of two headers differ.
int bits_apart(const Bytes& a, const Bytes& b) {
  int count = 0;
  for (std::size_t i = kClearSize; i < kHeaderSize; ++i) {
    count += std::popcount(std::to_integer<unsigned>(a[i] ^ b[i]));
  }
  return count;
}

// Of 96 bits half differ, as of any two strangers' datagrams: 48, with a standard deviation of 4.9
// for one pair and 0.1 for the mean of these.
TEST(AeadProtectionTest, ConnectionAndNumberCannotBeFollowed) {
  Ends ends;
  constexpr int kPairs = 2000;
  double apart = 0;
  Bytes before = sealed(ends.surgeon, {.connection = 7, .number = 0}, Bytes(40));
  for (std::uint64_t number = 1; number <= kPairs; ++number) {
    Bytes now = sealed(ends.surgeon, {.connection = 7, .number = number}, Bytes(40));
    apart += bits_apart(before, now);
    before = std::move(now);
  }
  EXPECT_NEAR(apart / kPairs, 48, 0.6);
}

TEST(AeadProtectionTest, TheWholeTagMakesTheMask) {
  Ends ends;
  const Bytes datagram = sealed(ends.surgeon, {.connection = 7, .number = 5}, Bytes(40));
  EXPECT_EQ(ends.patient.read_header(datagram)->number, 5U);
  for (std::size_t bit = 0; bit < 8 * AeadProtection::kTagSize; ++bit) {
    Bytes spoiled = datagram;
    spoiled[spoiled.size() - 1 - bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    const auto header = ends.patient.read_header(spoiled);
    EXPECT_FALSE(header && header->connection == 7U);
  }
}

TEST(AeadProtectionDeathTest, ANumberIsSealedOnce) {
  AeadProtection protection{some_keys(1, Role::Surgeon).data};
  (void)sealed(protection, {.number = 5}, Bytes(20));
  EXPECT_DEATH((void)sealed(protection, {.number = 5}, Bytes(20)), "sealed once");
  EXPECT_DEATH((void)sealed(protection, {.number = 4}, Bytes(20)), "sealed once");
}

TEST(AeadProtectionTest, SealsNothingWhereTheRoomIsTooSmall) {
  AeadProtection protection{some_keys(1, Role::Surgeon).data};
  Bytes out(kHeaderSize + 20 + AeadProtection::kTagSize);
  EXPECT_EQ(protection.seal({.number = 1}, Bytes(21), out), 0U);
  EXPECT_EQ(protection.seal({.number = 1}, Bytes(20), out), out.size());
  Bytes room(19);
  AeadProtection peer{some_keys(1, Role::Patient).data};
  EXPECT_EQ(whole_open(peer, out, room).error(), Rejection::Malformed);
}

/// A changeover from handshake 1 to handshake 2, seen from `role`.
AeadProtection changing(Role role, Lead lead) {
  return {some_keys(1, role, 0).data, some_keys(2, role, 1).data, lead};
}

TEST(ChangeoverTest, BothGenerationsOpenAndTheLeaderSealsWithTheNewer) {
  AeadProtection surgeon = changing(Role::Surgeon, Lead::Own);
  AeadProtection patient = changing(Role::Patient, Lead::Peer);
  AeadProtection surgeon_before{some_keys(1, Role::Surgeon).data};
  Bytes room(2000);

  const Bytes late = sealed(surgeon_before, {.number = 10}, Bytes(20));
  const Bytes still = sealed(patient, {.number = 0}, Bytes(20));
  EXPECT_EQ(parse_clear_part(still)->key, 0U) << "the peer may not have the newer keys yet";
  EXPECT_TRUE(whole_open(surgeon, still, room));

  const Bytes newer = sealed(surgeon, {.number = 11}, Bytes(20));
  EXPECT_EQ(parse_clear_part(newer)->key, 1U);
  ASSERT_TRUE(whole_open(patient, newer, room));
  EXPECT_EQ(parse_clear_part(sealed(patient, {.number = 1}, Bytes(20)))->key, 1U);
  EXPECT_TRUE(whole_open(patient, late, room)) << "it was under way during the changeover";
}

TEST(ChangeoverTest, ForgedTrafficOfTheNewerGenerationMovesNothing) {
  AeadProtection patient = changing(Role::Patient, Lead::Peer);
  AeadProtection stranger{some_keys(3, Role::Surgeon, 1).data};
  Bytes room(2000);
  EXPECT_FALSE(whole_open(patient, sealed(stranger, {.number = 1}, Bytes(20)), room));
  EXPECT_EQ(parse_clear_part(sealed(patient, {.number = 1}, Bytes(20)))->key, 0U);
}

TEST(ChangeoverTest, WhatIsOverDoesNotOpenAnyMore) {
  AeadProtection after{some_keys(2, Role::Patient, 1).data};
  AeadProtection before{some_keys(1, Role::Surgeon, 0).data};
  Bytes room(2000);
  EXPECT_EQ(whole_open(after, sealed(before, {.number = 1}, Bytes(20)), room).error(),
            Rejection::Foreign);
}

}  // namespace
}  // namespace palp::link
