#include "common/io/net/udp_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/common/io/net/loopback.h"

namespace palp::io {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Bytes;
using test::bytes_of;
using test::PlainSocket;
using test::wait_until;

class UdpSocketTest : public testing::Test {
 protected:
  UdpSocketTest() {
    auto made = UdpSocket::connect(*resolve_endpoint("127.0.0.1:0"), peer_.local(), inbox_, {});
    EXPECT_TRUE(made.has_value());
    socket_ = std::move(*made);
  }

  /// What one tick takes: each data datagram, with the sizes told.
  std::vector<link::Datagram> tick() {
    const TimePoint now = clock_.now();
    std::vector<link::Datagram> taken;
    while (const auto datagram = socket_->receive(buffer_, now)) {
      taken.push_back(*datagram);
      socket_->recognised(now);
    }
    return taken;
  }

  /// Ticks until `count` data datagrams came. Bounded.
  std::vector<link::Datagram> ticks_until(std::size_t count) {
    std::vector<link::Datagram> all;
    EXPECT_TRUE(wait_until([&] {
      const auto taken = tick();
      all.insert(all.end(), taken.begin(), taken.end());
      return all.size() >= count;
    }));
    return all;
  }

  /// Ticks until so many datagrams of any kind were taken from the kernel.
  void ticks_until_received(std::uint64_t count) {
    EXPECT_TRUE(wait_until([&] {
      tick();
      return inbox_.counting.received >= count;
    }));
  }

  SteadyClock clock_;
  SideInbox inbox_;
  PlainSocket peer_;
  std::unique_ptr<UdpSocket> socket_;
  std::array<std::byte, link::kDatagramSizeMax> buffer_{};
};

TEST_F(UdpSocketTest, CarriesDataBothWaysUnchanged) {
  const Bytes sent = bytes_of(0x80, 177);
  ASSERT_TRUE(socket_->send(sent, clock_.now()));
  EXPECT_EQ(peer_.receive(), sent);

  ASSERT_TRUE(peer_.send_to(socket_->local(), sent));
  const auto taken = ticks_until(1);
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken[0].size, sent.size());
  EXPECT_TRUE(std::equal(sent.begin(), sent.end(), buffer_.begin()));
  EXPECT_EQ(inbox_.counting.sent, 1U);
  EXPECT_EQ(inbox_.counting.received, 1U);
}

TEST_F(UdpSocketTest, OnlyDataReachesTheCallerAllElseTheInbox) {
  const std::vector<std::uint8_t> firsts{0x81, 0x82, 0x83, 0x16, 0x00, 0x90, 0xFF, 0x80};
  for (const std::uint8_t first : firsts) {
    ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(first, 40)));
  }
  const auto taken = ticks_until(1);
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(buffer_[0], std::byte{0x80});
  EXPECT_EQ(inbox_.counting.set_aside, firsts.size() - 1);
  SideDatagram aside;
  for (std::size_t i = 0; i + 1 < firsts.size(); ++i) {
    ASSERT_TRUE(inbox_.datagrams.try_dequeue(aside));
    EXPECT_THAT(aside.datagram(), testing::ElementsAreArray(bytes_of(firsts[i], 40)));
    EXPECT_GT(aside.arrived_at, TimePoint{});
  }
  EXPECT_FALSE(inbox_.datagrams.try_dequeue(aside));
}

TEST_F(UdpSocketTest, TellsTheTrueLengthOfAnOverLongDatagram) {
  ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 1201)));
  ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 1200)));
  const auto taken = ticks_until(2);
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].size, 1201U);
  EXPECT_EQ(taken[1].size, 1200U);
}

TEST_F(UdpSocketTest, OverLongOrEmptyNoiseIsDroppedAndCounted) {
  ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x81, 1201)));
  ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x81, 60'000)));
  ASSERT_TRUE(peer_.send_to(socket_->local(), {}));
  ticks_until_received(3);
  EXPECT_EQ(inbox_.counting.dropped, 3U);
  EXPECT_EQ(inbox_.counting.set_aside, 0U);
}

TEST_F(UdpSocketTest, FullInboxDropsAndCounts) {
  constexpr std::uint64_t kSent = 200;
  for (std::uint64_t i = 0; i < kSent; ++i) {
    ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x81, 30)));
  }
  ticks_until_received(kSent);
  EXPECT_GE(inbox_.counting.set_aside, SideInbox::kCapacity);
  EXPECT_GT(inbox_.counting.dropped, 0U);
  EXPECT_EQ(inbox_.counting.set_aside + inbox_.counting.dropped, kSent);
}

TEST_F(UdpSocketTest, NoiseAndDataShareTheBudgetOfATick) {
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x81, 30)));
    ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 30)));
  }
  const auto first = tick();
  EXPECT_EQ(inbox_.counting.received, link::kDatagramsPerTickMax);
  EXPECT_EQ(first.size(), link::kDatagramsPerTickMax / 2);
  ticks_until_received(400);
}

TEST_F(UdpSocketTest, NobodyListeningIsCountedAndEndsNothing) {
  const Endpoint gone = peer_.local();
  peer_.close();
  EXPECT_TRUE(wait_until([&] {
    (void)socket_->send(bytes_of(0x80, 60), clock_.now());
    tick();
    return inbox_.counting.path_errors >= 3;
  }));
  PlainSocket back{gone.port()};
  ASSERT_TRUE(wait_until([&] { return socket_->send(bytes_of(0x80, 61), clock_.now()); }));
  EXPECT_TRUE(back.receive().has_value());
  ASSERT_TRUE(back.send_to(socket_->local(), bytes_of(0x80, 62)));
  EXPECT_EQ(ticks_until(1).front().size, 62U);
}

TEST_F(UdpSocketTest, ErrorOfAnEarlierDatagramCostsTheNextOneNothing) {
  const Endpoint gone = peer_.local();
  peer_.close();
  ASSERT_TRUE(socket_->send(bytes_of(0x80, 60), clock_.now()));
  PlainSocket back{gone.port()};
  ASSERT_TRUE(socket_->send(bytes_of(0x80, 61), clock_.now()));
  const auto received = back.receive();
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(received->size(), 61U);
  EXPECT_EQ(inbox_.counting.path_errors, 1U);
  EXPECT_EQ(inbox_.counting.unsent, 0U);
}

TEST_F(UdpSocketTest, ArrivalLiesBetweenSendingAndTheTickAndNeverFalls) {
  TimePoint last = clock_.now();
  for (int i = 0; i < 20; ++i) {
    const TimePoint before = clock_.now();
    ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 30)));
    const auto taken = ticks_until(1);
    // The wall clock may be slewed between the two readings, by far less than this.
    EXPECT_GE(taken.front().arrived_at, before - milliseconds{1});
    EXPECT_LE(taken.front().arrived_at, clock_.now());
    EXPECT_GE(taken.front().arrived_at, last - milliseconds{1});
    last = taken.front().arrived_at;
  }
  EXPECT_LT(inbox_.counting.without_stamp, 20U);  // a stalled machine may cost one or the other
}

// The kernel begins to stamp a moment after the first socket of the machine asked for it, and a
// stalled machine makes stamps old: hence the repetitions in the next two.
TEST_F(UdpSocketTest, ArrivalIsTheKernelsStampNotTheTimeOfTheDrain) {
  EXPECT_TRUE(wait_until([&] {
    EXPECT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 30)));
    const TimePoint sent_by = clock_.now();
    EXPECT_TRUE(wait_until([&] { return clock_.now() >= sent_by + milliseconds{20}; }));
    return ticks_until(1).front().arrived_at <= sent_by + milliseconds{5};
  }));
}

TEST_F(UdpSocketTest, StampOlderThanATenthOfASecondIsNotBelieved) {
  EXPECT_TRUE(wait_until([&] {
    EXPECT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 30)));
    const TimePoint later = clock_.now() + milliseconds{120};
    EXPECT_TRUE(wait_until([&] { return clock_.now() >= later; }));
    const TimePoint before = clock_.now();
    EXPECT_GE(ticks_until(1).front().arrived_at, before);
    return inbox_.counting.without_stamp > 0;
  }));
}

TEST_F(UdpSocketTest, WarmUpsTakeNothingAndStampsRemain) {
  constexpr std::size_t kMoreThanABatch = 70;
  for (std::size_t i = 0; i < kMoreThanABatch; ++i) {
    ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 40 + i)));
  }
  std::vector<std::size_t> sizes;
  ASSERT_TRUE(wait_until([&] {
    const TimePoint now = clock_.now();
    for (;;) {
      socket_->warm_up();
      const auto datagram = socket_->receive(buffer_, now);
      if (!datagram) break;
      sizes.push_back(datagram->size);
    }
    return sizes.size() >= kMoreThanABatch;
  }));
  socket_->warm_up();
  ASSERT_EQ(sizes.size(), kMoreThanABatch);
  for (std::size_t i = 0; i < kMoreThanABatch; ++i) EXPECT_EQ(sizes[i], 40 + i);
  EXPECT_EQ(inbox_.counting.received, kMoreThanABatch);
  EXPECT_EQ(inbox_.counting.without_stamp, 0U);
}

TEST_F(UdpSocketTest, WhatCameFromElsewhereIsTakenWhenThePeersAddressIsSilentAndAnsweredThere) {
  PlainSocket elsewhere;
  tick();  // from now on the peer has its chance
  const TimePoint arrived = clock_.now();
  for (const std::size_t size : {1199U, 1200U, 1201U, 2000U}) {
    ASSERT_TRUE(inbox_.detours.try_emplace(bytes_of(0x80, size), elsewhere.local(), arrived));
  }
  const auto taken = ticks_until(4);
  EXPECT_GE(clock_.now() - arrived, milliseconds{8});
  for (const link::Datagram& one : taken) {
    EXPECT_LE(one.size, buffer_.size());
    EXPECT_EQ(one.arrived_at, arrived);
  }
  ASSERT_TRUE(socket_->send(bytes_of(0x80, 177), clock_.now()));
  EXPECT_EQ(elsewhere.receive(), bytes_of(0x80, 177));
  EXPECT_EQ(peer_.receive(), bytes_of(0x80, 177));
  EXPECT_EQ(inbox_.counting.detoured, 1U);
}

TEST_F(UdpSocketTest, WhatCameFromElsewhereIsDroppedWhileThePeersAddressDelivers) {
  PlainSocket elsewhere;
  tick();
  ASSERT_TRUE(inbox_.detours.try_emplace(bytes_of(0x80, 300), elsewhere.local(), clock_.now()));
  TimePoint last = clock_.now();
  const TimePoint later = last + milliseconds{30};
  EXPECT_TRUE(wait_until([&] {
    EXPECT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 40)));
    const TimePoint before = std::exchange(last, clock_.now());
    for (const link::Datagram& one : tick()) {
      EXPECT_TRUE(one.size == 40 || clock_.now() - before >= Detour::kSilence) << "or stalled";
    }
    return clock_.now() > later;
  }));
  EXPECT_EQ(inbox_.detours.peek(), nullptr);
}

TEST_F(UdpSocketTest, HearsNobodyButItsPeer) {
  PlainSocket stranger;
  ASSERT_TRUE(stranger.send_to(socket_->local(), bytes_of(0x80, 31)));
  ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x80, 32)));
  const auto taken = ticks_until(1);
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken.front().size, 32U);
}

TEST_F(UdpSocketTest, WhatWasTakenEarlyNamesItsSender) {
  ASSERT_TRUE(peer_.send_to(socket_->local(), bytes_of(0x81, 33)));
  std::optional<UdpSocket::Stranger> early;
  EXPECT_TRUE(wait_until([&] {
    early = socket_->take_early(buffer_);
    return early.has_value();
  }));
  EXPECT_EQ(early->from, peer_.local());
  EXPECT_EQ(early->size, 33U);
  EXPECT_FALSE(socket_->take_early(buffer_).has_value());
}

/// The TOS byte of the datagram that comes next, as its receiver sees it.
int class_of_next(int socket) {
  std::array<std::byte, 2000> bytes{};
  std::array<std::byte, 100> control{};
  iovec block{.iov_base = bytes.data(), .iov_len = bytes.size()};
  msghdr message{};
  message.msg_iov = &block;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  EXPECT_GT(::recvmsg(socket, &message, 0), 0);
  const cmsghdr* one = CMSG_FIRSTHDR(&message);
  return one == nullptr ? -1
                        : std::to_integer<int>(*reinterpret_cast<const std::byte*>(CMSG_DATA(one)));
}

TEST(UdpSocketConnectTest, TelegramsAreExpeditedToPeersOfIpv4AlsoFromASocketOfIpv6) {
  for (const char* family : {"127.0.0.1:", "[::ffff:127.0.0.1]:"}) {
    const Descriptor receiver = test::bound_to(*resolve_endpoint("127.0.0.1:0"), false);
    const int on = 1;
    ASSERT_EQ(setsockopt(receiver.number(), IPPROTO_IP, IP_RECVTOS, &on, sizeof on), 0);
    sockaddr_in place{};
    socklen_t size = sizeof place;
    ASSERT_EQ(getsockname(receiver.number(), reinterpret_cast<sockaddr*>(&place), &size), 0);
    const Endpoint peer = *resolve_endpoint(family + std::to_string(ntohs(place.sin_port)));
    SideInbox inbox;
    const auto socket = UdpSocket::connect(peer.caller(), peer, inbox, {});
    if (!socket && peer.family() == AF_INET6) GTEST_SKIP() << "no IPv6 here";
    ASSERT_TRUE(socket);
    ASSERT_TRUE((*socket)->send(bytes_of(0x80, 50), SteadyClock{}.now()));
    EXPECT_EQ(class_of_next(receiver.number()), 46 << 2);
  }
}

/// A UDP socket with `option` at the place of another. @returns whether it got there.
bool gets_in(const Endpoint& place, int option) {
  const Descriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  const int on = 1;
  EXPECT_EQ(::setsockopt(socket.number(), SOL_SOCKET, option, &on, sizeof on), 0);
  return ::bind(socket.number(), place.address(), place.size()) == 0;
}

/// The same as user nobody; false as well where this program may not become another user.
bool gets_in_as_another(const Endpoint& place) {
  if (::geteuid() != 0 || ::seteuid(65534) != 0) return false;
  const bool in = gets_in(place, SO_REUSEPORT) || gets_in(place, SO_REUSEADDR);
  EXPECT_EQ(::seteuid(0), 0);
  return in;
}

TEST(SharePortTest, OnlySocketsOfTheSameUserGetIn) {
  const PlainSocket listening;
  const PlainSocket peer;
  const Endpoint place = listening.local();
  EXPECT_FALSE(gets_in(place, SO_REUSEPORT));
  share_port(listening.descriptor(), true);
  EXPECT_FALSE(gets_in(place, SO_REUSEADDR)) << "what any user of the machine can set";
  EXPECT_TRUE(gets_in(place, SO_REUSEPORT));
  EXPECT_FALSE(gets_in_as_another(place));
  share_port(listening.descriptor(), false);
  EXPECT_FALSE(gets_in(place, SO_REUSEPORT));
  SideInbox inbox;
  share_port(listening.descriptor(), true);
  const auto connected = UdpSocket::connect(place, peer.local(), inbox, {});
  share_port(listening.descriptor(), false);
  ASSERT_TRUE(connected);
  EXPECT_FALSE(gets_in(place, SO_REUSEADDR)) << "in a session";
  EXPECT_FALSE(gets_in_as_another(place)) << "in a session";
}

TEST(SharePortTest, StrangersReachTheListeningSocketAndThePeerItsOwn) {
  const PlainSocket listening;
  PlainSocket peer;
  SideInbox inbox;
  for (int session = 0; session < 3; ++session) {
    share_port(listening.descriptor(), true);
    const auto connected = UdpSocket::connect(listening.local(), peer.local(), inbox, {});
    share_port(listening.descriptor(), false);
    ASSERT_TRUE(connected) << connected.error().text;
    for (int i = 0; i < 20; ++i) {
      PlainSocket stranger;
      ASSERT_TRUE(stranger.send_to(listening.local(), Bytes(3, std::byte{1})));
      std::array<std::byte, 8> heard{};
      EXPECT_EQ(::recv(listening.descriptor(), heard.data(), heard.size(), 0), 3);
    }
    ASSERT_TRUE(peer.send_to(listening.local(), Bytes(5, kDataFirstByte)));
    std::array<std::byte, link::kDatagramSizeMax> buffer{};
    const SteadyClock clock;
    EXPECT_TRUE(wait_until([&] { return (*connected)->receive(buffer, clock.now()).has_value(); }));
  }
}

TEST(UdpSocketConnectTest, SaysInASentenceWhyItCannot) {
  SideInbox inbox;
  PlainSocket taken;
  const auto made = UdpSocket::connect(taken.local(), taken.local(), inbox, {});
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().text,
            "cannot use " + taken.local().to_string() + ": address already in use");
}

}  // namespace
}  // namespace palp::io
