// Goal: what a whole session under keys costs in bytes, and that a peer whose address changes is
// heard all the time.
// Method: both sites in virtual time, handshake included; every datagram is counted.
#include <gtest/gtest.h>

#include "tests/common/io/secure/secure_world.h"

namespace palp::io {
namespace {

using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::World;

/// As in a session with all that a telegram of the default law can hold.
void fill_telegrams(World& world) {
  for (test::Site* site : {world.surgeon.get(), world.patient.get()}) {
    site->telegram.site = {
        .state = SiteState::Engaged, .epoch = 3, .place = {1e-3, 0}, .depth = {}};
    site->telegram.port = {.position = 1e-3, .velocity = 0.02, .force = 0.3, .payload = {}};
  }
  world.patient->telegram.site.depth = {.number = 4, .depth = 1e-2, .depth_low = 9e-3};
  world.patient->telegram.port.payload =
      ModelPayload{.version = 70'000, .c = {1, 2, 3, 4}, .surface = 1, .depth_max = 1};
}

TEST(SecureSessionTest, AWholeSessionKeepsItsBudgetOfBytesAndDatagrams) {
  World world{"budget", seconds{7}};  // new keys within it
  world.way = milliseconds{20};
  fill_telegrams(world);
  std::size_t telegrams = 0;
  std::size_t letters = 0;
  world.on_the_way = [&](std::span<const std::byte> bytes) {
    EXPECT_LE(bytes.size(), link::kDatagramSizeMax);
    const auto header = link::parse_clear_part(bytes);
    const bool telegram = header && header->type == link::PacketType::Data;
    ++(telegram ? telegrams : letters);
    if (!telegram) return;
    // Header and tag, and nothing else, is what security adds to the telegram itself.
    EXPECT_EQ(bytes.size() - header->length, link::kHeaderSize);
    EXPECT_LE(link::kHeaderSize + link::AeadProtection::kTagSize, 32U);
  };
  world.run(seconds{20});
  ASSERT_TRUE(world.live());
  const std::uint64_t samples =
      world.surgeon->link.health(world.now).sent + world.patient->link.health(world.now).sent;
  ASSERT_GT(samples, 39'000U);
  EXPECT_EQ(telegrams, samples) << "one datagram for each";
  EXPECT_LE(static_cast<double>(telegrams + letters), 1.05 * static_cast<double>(samples));
}

/// The longest time that an end heard nothing, from the first change of address on.
struct Gaps {
  Duration surgeon{};
  Duration patient{};
};

Gaps gaps_over_rebindings(World& world, int times) {
  Gaps gaps;
  world.run(seconds{3});
  EXPECT_TRUE(world.live());
  for (int i = 0; i < times; ++i) {
    world.surgeon_seen_at = *resolve_endpoint("127.0.0.1:" + std::to_string(3000 + i));
    for (int ms = 0; ms < 1000; ++ms) {
      world.run(milliseconds{1});
      gaps.surgeon = std::max(gaps.surgeon, world.surgeon->link.health(world.now).gap);
      gaps.patient = std::max(gaps.patient, world.patient->link.health(world.now).gap);
    }
  }
  return gaps;
}

TEST(SecureSessionTest, AChangeOfAddressCostsTheSurgeonARoundTripAndBothTenMilliseconds) {
  for (const Duration way : {milliseconds{0}, milliseconds{25}, milliseconds{150}}) {
    World world{"gap"};
    world.way = way;
    const Gaps gaps = gaps_over_rebindings(world, 20);
    EXPECT_LE(gaps.surgeon, 2 * way + milliseconds{15}) << "what was on its way to the old address";
    EXPECT_LE(gaps.patient, milliseconds{12}) << "until the former address counts as silent";
    EXPECT_EQ(world.patient->moved_to.size(), 20U);
    EXPECT_EQ(world.patient->established.size(), 1U);
    EXPECT_EQ(world.patient->rekeyed, 0) << "no new handshake";
  }
}

}  // namespace
}  // namespace palp::io
