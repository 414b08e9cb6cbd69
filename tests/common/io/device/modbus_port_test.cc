#include "common/io/device/modbus_port.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "tests/common/io/device/modbus_line.h"

namespace palp::io {
namespace {

struct Spoiled {
  const char* reply;
  PortFault fault;
};

class ModbusFaultTest : public testing::TestWithParam<Spoiled> {};

TEST_P(ModbusFaultTest, IsToldApart) {
  Line line;
  ModbusPort port{line.address()};
  ASSERT_EQ(port.open(), PortFault::None);
  std::array<std::uint16_t, 2> words{};
  PortFault fault{};
  line.hear(8, bytes_of(GetParam().reply), [&] { fault = port.read(0x9000, words, false); });
  EXPECT_EQ(fault, GetParam().fault);
  // And the line is clear for the next.
  line.hear(8, bytes_of("01 03 04 00 00 0B FE 7C 83"), [&] {
    EXPECT_EQ(port.read(0x9000, words, false), PortFault::None);
  });
  EXPECT_EQ(words[1], 3070);
}

INSTANTIATE_TEST_SUITE_P(
    Replies,
    ModbusFaultTest,
    testing::Values(Spoiled{"", PortFault::NoReply},
                    Spoiled{"01 03 04 00 00", PortFault::NoReply},
                    Spoiled{"01 03 04 00 00 0B FE 7C 84", PortFault::BrokenFrame},
                    Spoiled{"01 83 02 C0 F1", PortFault::Refused},
                    Spoiled{"02 03 04 00 00 0B FE 4F 83", PortFault::WrongStation}));

TEST(ModbusPortTest, ALateAnswerIsNotTakenForTheNext) {
  const Line line;
  ModbusPort port{line.address()};
  ASSERT_EQ(port.open(), PortFault::None);
  std::array<std::uint16_t, 2> words{};
  line.hear(8, {}, [&] { EXPECT_EQ(port.read(0x9000, words, false), PortFault::NoReply); });
  line.say(bytes_of("01 03 04 00 00 00 00 FA 33"));
  line.hear(8, bytes_of("01 03 04 00 00 0B FE 7C 83"), [&] {
    EXPECT_EQ(port.read(0x9000, words, false), PortFault::None);
  });
  EXPECT_EQ(words[1], 3070);
}

/// A server of TCP that answers each of two connections once: 3070 at the asked register, the
/// first time with the transaction's number changed by `wrong`.
void answer_twice(int listener, std::uint8_t wrong) {
  for (const std::uint8_t change : {wrong, std::uint8_t{0}}) {
    pollfd one{.fd = listener, .events = POLLIN, .revents = 0};
    if (::poll(&one, 1, 5000) <= 0) return;
    const int peer = ::accept(listener, nullptr, nullptr);
    std::array<std::uint8_t, 12> asked{};
    EXPECT_EQ(::recv(peer, asked.data(), asked.size(), MSG_WAITALL), 12);
    Bytes reply{asked[0], asked[1], 0, 0, 0, 5, asked[6], 3, 2, 0x0B, 0xFE};
    reply[1] ^= change;
    EXPECT_EQ(::send(peer, reply.data(), reply.size(), MSG_NOSIGNAL), 11);
    std::uint8_t end{};
    (void)::recv(peer, &end, 1, 0);  // till the other side closes
    ::close(peer);
  }
}

TEST(ModbusPortTest, AnAnswerToAnotherTransactionIsRefusedAndANewConnectionGoesOn) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof here;
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&here), size), 0);
  ASSERT_EQ(::listen(listener, 2), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&here), &size), 0);
  std::jthread server{[listener] { answer_twice(listener, 1); }};
  ModbusAddress address;
  address.host = "127.0.0.1";
  address.port = ntohs(here.sin_port);
  {
    ModbusPort port{address};
    ASSERT_EQ(port.open(), PortFault::None);
    std::array<std::uint16_t, 1> words{};
    EXPECT_EQ(port.read(0x9000, words, false), PortFault::BrokenFrame);
    EXPECT_EQ(port.read(0x9000, words, false), PortFault::None);
    EXPECT_EQ(words[0], 3070);
  }
  server.join();
  ::close(listener);
}

TEST(ModbusPortTest, ALineThatGoesAwayIsLost) {
  Line line;
  ModbusPort port{line.address()};
  ASSERT_EQ(port.open(), PortFault::None);
  line.hang_up();
  std::array<std::uint16_t, 2> words{};
  EXPECT_EQ(port.read(0x9000, words, false), PortFault::Lost);
  EXPECT_EQ(port.read(0x9000, words, false), PortFault::Lost);
}

TEST(ModbusPortTest, WhatIsNotThereCannotBeOpened) {
  ModbusAddress nowhere;
  nowhere.line = "/dev/null/none";
  ModbusPort port{nowhere};
  EXPECT_EQ(port.open(), PortFault::NotOpen);
  std::array<std::uint16_t, 1> words{};
  EXPECT_EQ(port.read(0, words, true), PortFault::Lost);
}

TEST(ModbusAddressTest, ReadsBothKinds) {
  const auto tcp = parse_modbus_address("tcp:192.168.0.9:502");
  ASSERT_TRUE(tcp);
  EXPECT_EQ(tcp->host, "192.168.0.9");
  EXPECT_EQ(tcp->port, 502);
  const auto serial = parse_modbus_address("serial:/dev/ttyUSB0");
  ASSERT_TRUE(serial);
  EXPECT_EQ(serial->line, "/dev/ttyUSB0");
  for (const char* bad : {"",
                          "tcp:",
                          "tcp:1.2.3.4",
                          "tcp::502",
                          "tcp:1.2.3.4:0",
                          "tcp:1.2.3.4:70000",
                          "tcp:1.2.3.4:5x",
                          "serial:",
                          "usb:1"}) {
    EXPECT_FALSE(parse_modbus_address(bad)) << bad;
  }
}

TEST(ReplyTimeTest, GrowsWithBytesAndDelayAndFallsWithBaud) {
  ModbusAddress slow;
  slow.line = "x";
  slow.baud = 19'200;
  slow.parity = 'E';
  ModbusAddress fast = slow;
  fast.baud = 1'000'000;
  EXPECT_EQ(reply_time_max(slow, 38) - reply_time_max(fast, 38),
            from_seconds(38 * 11.0 / 19'200) - from_seconds(38 * 11.0 / 1'000'000));
  fast.reply_delay = std::chrono::milliseconds{6};
  EXPECT_GT(reply_time_max(fast, 38), std::chrono::milliseconds{6});
}

}  // namespace
}  // namespace palp::io
