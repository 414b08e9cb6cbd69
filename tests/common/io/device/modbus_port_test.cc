#include "common/io/device/modbus_port.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): of the system's own
#include <unistd.h>

namespace palp::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(std::string_view hex) {
  Bytes bytes;
  std::string digits;
  for (const char c : hex) {
    if (c == ' ') continue;
    digits += c;
    if (digits.size() == 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return bytes;
}

/// The far end of a pseudo-terminal: hears one request of a known length and answers as told.
class Line {
 public:
  Line() : master_{::posix_openpt(O_RDWR | O_NOCTTY)} {
    EXPECT_GE(master_, 0);
    EXPECT_EQ(::grantpt(master_), 0);
    EXPECT_EQ(::unlockpt(master_), 0);
    std::array<char, 64> name{};
    EXPECT_EQ(::ptsname_r(master_, name.data(), name.size()), 0);
    address_.line = name.data();
  }
  ~Line() { hang_up(); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  [[nodiscard]] const ModbusAddress& address() const { return address_; }
  void hang_up() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }
  void say(const Bytes& bytes) const {
    EXPECT_EQ(::write(master_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// What was asked while `call` ran; answered with `reply`.
  Bytes hear(std::size_t length, const Bytes& reply, const std::function<void()>& call) const {
    Bytes heard;
    std::jthread far_end{[&] {
      while (heard.size() < length) {
        pollfd one{.fd = master_, .events = POLLIN, .revents = 0};
        if (::poll(&one, 1, 5000) <= 0) return;
        std::array<std::uint8_t, 256> buffer{};
        const auto count = ::read(master_, buffer.data(), length - heard.size());
        if (count <= 0) return;
        heard.insert(heard.end(), buffer.begin(), buffer.begin() + count);
      }
      EXPECT_EQ(::write(master_, reply.data(), reply.size()), static_cast<ssize_t>(reply.size()));
    }};
    call();
    far_end.join();
    return heard;
  }

 private:
  int master_;
  ModbusAddress address_;
};

struct Vector {
  const char* name;
  const char* request;
  const char* reply;
  std::function<void(ModbusPort&)> call;
};

/// Data sheets' frames, and some computed from them, with their checksums. One list.
// NOLINTNEXTLINE(readability-function-size): a table
std::vector<Vector> vectors() {
  const auto reads = [](std::uint16_t address, const std::vector<std::uint16_t>& expected) {
    return [address, expected](ModbusPort& port) {
      std::vector<std::uint16_t> words(expected.size());
      EXPECT_EQ(port.read(address, words, false), PortFault::None);
      EXPECT_EQ(words, expected);
    };
  };
  const auto writes = [](std::uint16_t address, const std::vector<std::uint16_t>& words) {
    return [address, words](ModbusPort& port) {
      EXPECT_EQ(port.write(address, words), PortFault::None);
    };
  };
  const auto writes_one = [](std::uint16_t address, std::uint16_t word) {
    return [address, word](ModbusPort& port) {
      EXPECT_EQ(port.write_one(address, word), PortFault::None);
    };
  };
  const auto coil = [](std::uint16_t address) {
    return
        [address](ModbusPort& port) { EXPECT_EQ(port.write_coil(address, true), PortFault::None); };
  };
  return {
      {"IAI, position of 30.70 mm",
       "01 03 90 00 00 02 E9 0B",
       "01 03 04 00 00 0B FE 7C 83",
       reads(0x9000, {0, 3070})},
      {"IAI, move to 50 mm",
       "01 10 99 00 00 09 12 00 00 13 88 00 00 00 0A 00 00 27 10 00 1E 00 00 00 00 9F 82",
       "01 10 99 00 00 09 2E 93",
       writes(0x9900, {0, 5000, 0, 10, 0, 10'000, 30, 0, 0})},
      {"IAI, move by 10 mm",
       "01 10 99 00 00 09 12 00 00 03 E8 00 00 00 0A 00 00 27 10 00 1E 00 00 00 08 F3 A0",
       "01 10 99 00 00 09 2E 93",
       writes(0x9900, {0, 1000, 0, 10, 0, 10'000, 30, 0, 8})},
      {"IAI, target alone",
       "01 10 99 00 00 02 04 00 00 04 D2 B7 64",
       "01 10 99 00 00 02 6F 54",
       writes(0x9900, {0, 1234})},
      {"IAI, control to Modbus", "01 05 04 27 FF 00 3D 01", "01 05 04 27 FF 00 3D 01", coil(0x427)},
      {"IAI, servo on", "01 05 04 03 FF 00 7D 0A", "01 05 04 03 FF 00 7D 0A", coil(0x403)},
      {"IAI, alarm reset", "01 05 04 07 FF 00 3C CB", "01 05 04 07 FF 00 3C CB", coil(0x407)},
      {"IAI, home", "01 05 04 0B FF 00 FC C8", "01 05 04 0B FF 00 FC C8", coil(0x40B)},
      {"IAI, stop", "01 05 04 2C FF 00 4C C3", "01 05 04 2C FF 00 4C C3", coil(0x42C)},
      {"ORCA, force and state in one",
       "01 17 01 56 00 08 00 1C 00 02 04 01 F4 00 00 6C 7E",
       "01 17 10 30 39 00 00 00 00 00 00 00 00 00 00 01 F4 00 00 0C A5",
       [](ModbusPort& port) {
         const std::array<std::uint16_t, 2> force{500, 0};
         std::array<std::uint16_t, 8> words{};
         EXPECT_EQ(port.exchange(28, force, 342, words), PortFault::None);
         EXPECT_THAT(words, testing::ElementsAre(12'345, 0, 0, 0, 0, 0, 500, 0));
       }},
      {"ORCA, position control",
       "01 10 00 1E 00 02 04 03 E8 00 00 F3 5F",
       "01 10 00 1E 00 02 21 CE",
       writes(30, {1000, 0})},
      {"ORCA, force mode", "01 06 00 03 00 02 F8 0B", "01 06 00 03 00 02 F8 0B", writes_one(3, 2)},
      {"ORCA, sleep", "01 06 00 03 00 01 B8 0A", "01 06 00 03 00 01 B8 0A", writes_one(3, 1)},
      {"ORCA, watchdog", "01 06 00 A3 00 32 F8 3D", "01 06 00 A3 00 32 F8 3D", writes_one(163, 50)},
      {"AZ, -1000 to a register",
       "01 10 18 02 00 02 04 FF FF FC 18 99 58",
       "01 10 18 02 00 02 E6 A8",
       writes(0x1802, {0xFFFF, 0xFC18})},
      {"AZ, stop",
       "01 10 00 7C 00 02 04 00 00 00 20 F5 06",
       "01 10 00 7C 00 02 80 10",
       writes(0x7C, {0, 32})},
  };
}

class ModbusVectorTest : public testing::TestWithParam<Vector> {};

TEST_P(ModbusVectorTest, GoesOverTheLineByteForByte) {
  Line line;
  ModbusPort port{line.address()};
  ASSERT_EQ(port.open(), PortFault::None);
  const Bytes request = bytes_of(GetParam().request);
  const Bytes heard =
      line.hear(request.size(), bytes_of(GetParam().reply), [&] { GetParam().call(port); });
  EXPECT_EQ(heard, request) << GetParam().name;
}

INSTANTIATE_TEST_SUITE_P(DataSheets, ModbusVectorTest, testing::ValuesIn(vectors()));

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
