// Goal: what somebody who listens on the way sees of a session.
// Method: a packet socket on the loopback interface beside two sites under keys.
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/udp.h>

#include "tests/bench/secure_site.h"
#include "tests/common/io/net/loopback.h"
#include "tests/common/io/secure/keys_folder.h"

namespace palp::io {
namespace {

using link::Role;

/// What was seen of one datagram.
struct Seen {
  int dscp{};
  bool may_be_fragmented{};
  std::vector<std::byte> content;
};

/// All IPv4 packets of the loopback interface.
Descriptor listen_to_loopback() {
  Descriptor socket{::socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  sockaddr_ll place{};
  place.sll_family = AF_PACKET;
  place.sll_protocol = htons(ETH_P_IP);
  place.sll_ifindex = static_cast<int>(::if_nametoindex("lo"));
  if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    socket.close();
  }
  return socket;
}

/// The datagram in an IPv4 packet, if it is one from or to `port`.
std::optional<Seen> datagram_of(std::span<const std::byte> packet, std::uint16_t port) {
  iphdr ip{};
  udphdr udp{};
  if (packet.size() < sizeof ip + sizeof udp) return std::nullopt;
  std::memcpy(&ip, packet.data(), sizeof ip);
  const std::size_t header = std::size_t{ip.ihl} * 4;
  if (ip.protocol != IPPROTO_UDP || packet.size() < header + sizeof udp) return std::nullopt;
  std::memcpy(&udp, packet.data() + header, sizeof udp);
  if (ntohs(udp.source) != port && ntohs(udp.dest) != port) return std::nullopt;
  const auto content = packet.subspan(header + sizeof udp);
  return Seen{.dscp = ip.tos >> 2,
              .may_be_fragmented = (ntohs(ip.frag_off) & IP_DF) == 0,
              .content = {content.begin(), content.end()}};
}

/// The sum of chi squared of `bytes` against all 256 values alike: 255 on average if they are.
double unlikeness(const std::vector<std::byte>& bytes) {
  std::array<double, 256> counts{};
  for (const std::byte one : bytes) ++counts[std::to_integer<std::size_t>(one)];
  const double expected = static_cast<double>(bytes.size()) / 256;
  double sum = 0;
  for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

TEST(CaptureTest, AListenerSeesTelegramsOfClassEfThatLookLikeNoise) {
  const Descriptor ear = listen_to_loopback();
  if (!ear.valid()) GTEST_SKIP() << "needs the right to open packet sockets";
  const test::KeysFolder keys{"capture"};
  const auto surgeon_keys = keys.credentials(Role::Surgeon);
  const auto patient_keys = keys.credentials(Role::Patient);
  bench::SecureSite patient{Role::Patient, 0, *patient_keys};
  const std::uint16_t port = patient.server.local().port();
  bench::SecureSite surgeon{Role::Surgeon, port, *surgeon_keys};
  for (bench::SecureSite* site : {&patient, &surgeon}) {
    site->start([site](TimePoint now) {
      (void)site->link.receive(now);
      site->link.send({}, now);
    });
  }
  std::vector<Seen> telegrams;
  std::array<std::byte, 4096> packet{};
  ASSERT_TRUE(test::wait_until([&] {
    for (;;) {
      const ssize_t got = ::recv(ear.number(), packet.data(), packet.size(), 0);
      if (got <= 0) break;
      const auto seen = datagram_of(std::span{packet}.first(static_cast<std::size_t>(got)), port);
      if (!seen) continue;
      EXPECT_LE(seen->content.size(), link::kDatagramSizeMax);
      if (!seen->content.empty() && seen->content[0] == kDataFirstByte) telegrams.push_back(*seen);
    }
    return telegrams.size() >= 1000;
  }));
  std::vector<std::byte> sealed;
  for (const Seen& one : telegrams) {
    EXPECT_EQ(one.dscp, 46);
    EXPECT_FALSE(one.may_be_fragmented);
    sealed.insert(sealed.end(), one.content.begin() + link::kHeaderSize, one.content.end());
  }
  // Five standard deviations; telegrams as they are, mostly zeros, would be thousands away.
  EXPECT_LE(unlikeness(sealed), 255 + 5 * std::sqrt(2.0 * 255));
  surgeon.server.close("done");
  patient.server.close("done");
  surgeon.rt->stop();
  patient.rt->stop();
}

}  // namespace
}  // namespace palp::io
