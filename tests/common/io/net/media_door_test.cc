#include "common/io/net/media_door.h"

#include "common/io/net/udp_socket.h"
#include "tests/common/io/net/loopback.h"

namespace palp::io {
namespace {

const Endpoint kStranger = *resolve_endpoint("127.0.0.1:1");

TEST(MediaDoorTest, TakesWhatBeginsLikeVideoAndNothingElse) {
  MediaDoor door;
  EXPECT_FALSE(MediaDoor::take(&door, {}, kStranger, {}));
  EXPECT_FALSE(MediaDoor::take(&door, test::bytes_of(0x80, 40), kStranger, {}));
  EXPECT_TRUE(MediaDoor::take(&door, test::bytes_of(0x85, 40), kStranger, {}));
  SideDatagram taken;
  ASSERT_TRUE(door.heard.try_dequeue(taken));
  EXPECT_EQ(taken.from, kStranger);
  EXPECT_EQ(taken.size, 40U);
  EXPECT_FALSE(door.heard.try_dequeue(taken));
  EXPECT_TRUE(MediaDoor::take(nullptr, test::bytes_of(0x85, 40), kStranger, {}));
}

TEST(MediaDoorTest, AFloodIsLeftOut) {
  MediaDoor door;
  for (int i = 0; i < 10000; ++i)
    EXPECT_TRUE(MediaDoor::take(&door, test::bytes_of(0x85, 9), kStranger, {}));
  std::size_t kept = 0;
  for (SideDatagram taken; door.heard.try_dequeue(taken);) ++kept;
  EXPECT_LT(kept, 4 * MediaDoor::kDatagrams);
}

TEST(MediaDoorTest, ASecondSocketOfThePortHearsItsPeerAlone) {
  MediaDoor door;
  test::PlainSocket peer;
  test::PlainSocket other;
  Descriptor listening = test::bound_to(*resolve_endpoint("127.0.0.1:0"), false);
  sockaddr_storage name{};
  socklen_t length = sizeof name;
  ASSERT_EQ(::getsockname(listening.number(), reinterpret_cast<sockaddr*>(&name), &length), 0);
  const Endpoint local{&name, length};
  ASSERT_TRUE(door.wanted.try_enqueue(peer.local()));
  door.serve(listening.number(), local);
  std::unique_ptr<DatagramSocket> way;
  ASSERT_TRUE(door.ways.try_dequeue(way));
  EXPECT_FALSE(test::can_share(local)) << "nobody else gets the port";
  ASSERT_TRUE(other.send_to(local, test::bytes_of(0x85, 10)));
  ASSERT_TRUE(peer.send_to(local, test::bytes_of(0x85, 20)));
  std::size_t size = 0;
  ASSERT_TRUE(test::wait_until([&] {
    for (const ReceivedDatagram& one : way->receive()) size = one.bytes.size();
    return size > 0;
  }));
  EXPECT_EQ(size, 20U);
  ASSERT_TRUE(way->send(test::bytes_of(1, 5), std::nullopt));
  const auto answer = peer.receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->size(), 5U);
}

TEST(MediaDoorTest, LettersLeaveFromThePort) {
  MediaDoor door;
  test::PlainSocket peer;
  Descriptor listening = test::bound_to(*resolve_endpoint("127.0.0.1:0"), false);
  ASSERT_TRUE(door.letters.try_emplace(test::bytes_of(0x85, 30), peer.local(), TimePoint{}));
  door.serve(listening.number(), {});
  const auto letter = peer.receive();
  ASSERT_TRUE(letter);
  EXPECT_EQ(letter->size(), 30U);
}

}  // namespace
}  // namespace palp::io
