#include "common/link/traffic_keys.h"

#include <algorithm>
#include <array>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/link/some_keys.h"

namespace palp::link {
namespace {

TEST(SessionKeysTest, WhatOneEndSendsTheOtherReceives) {
  const SessionKeys surgeon = some_keys(1, Role::Surgeon);
  const SessionKeys patient = some_keys(1, Role::Patient);
  EXPECT_EQ(surgeon.data.send.key, patient.data.receive.key);
  EXPECT_EQ(surgeon.data.send.salt, patient.data.receive.salt);
  EXPECT_EQ(surgeon.data.receive.key, patient.data.send.key);
  EXPECT_EQ(surgeon.control.send.key, patient.control.receive.key);
  EXPECT_EQ(surgeon.control.receive.key, patient.control.send.key);
  EXPECT_EQ(surgeon.send_connection, patient.receive_connection);
  EXPECT_EQ(surgeon.receive_connection, patient.send_connection);
  EXPECT_NE(surgeon.send_connection, 0U);
}

TEST(SessionKeysTest, DirectionsPlanesAndHandshakesShareNothing) {
  std::vector<AeadKey> all;
  for (const std::uint64_t handshake : {1U, 2U}) {
    const SessionKeys keys = some_keys(handshake, Role::Surgeon);
    for (const TrafficKeys& plane : {keys.data, keys.control}) {
      all.push_back(plane.send);
      all.push_back(plane.receive);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(all[i].key == all[k].key);
      EXPECT_FALSE(all[i].salt == all[k].salt);
    }
  }
}

TEST(PlaneKeysTest, WhatOneEndSendsTheOtherReceives) {
  std::array<std::byte, PlaneKeys::kExportedSize> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i);
  const PlaneKeys surgeon = PlaneKeys::from_exported(bytes, Role::Surgeon);
  const PlaneKeys patient = PlaneKeys::from_exported(bytes, Role::Patient);
  EXPECT_EQ(surgeon.keys.send.key, patient.keys.receive.key);
  EXPECT_EQ(surgeon.keys.receive.salt, patient.keys.send.salt);
  EXPECT_EQ(surgeon.send_connection, patient.receive_connection);
  EXPECT_EQ(surgeon.receive_connection, patient.send_connection);
  EXPECT_FALSE(surgeon.keys.send.key == surgeon.keys.receive.key);
}

TEST(SecretTest, LeavesNothingBehind) {
  using Bytes = std::array<std::byte, 16>;
  alignas(Secret<16>) std::array<std::byte, sizeof(Secret<16>)> place{};
  Bytes bytes{};
  bytes.fill(std::byte{0xA5});
  auto* secret = new (place.data()) Secret<16>{bytes};
  EXPECT_TRUE(std::ranges::equal(secret->bytes(), bytes));
  secret->~Secret<16>();
  EXPECT_EQ(std::ranges::count(place, std::byte{0xA5}), 0);
}

}  // namespace
}  // namespace palp::link
