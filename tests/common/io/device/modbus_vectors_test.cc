// Frames of data sheets, and some computed from them, with their checksums, over a real line.
#include <gmock/gmock.h>

#include "tests/common/io/device/modbus_line.h"

namespace palp::io {
namespace {

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
      {"IAI, state and position in one",
       "01 03 90 00 00 0A E8 CD",
       "01 03 14 00 00 0B FE 00 00 00 00 00 00 30 10 00 00 00 00 00 00 00 00 3C 2E",
       reads(0x9000, {0, 3070, 0, 0, 0, 0x3010, 0, 0, 0, 0})},
      {"ORCA, the other way",
       "01 17 01 56 00 08 00 1C 00 02 04 FE 0C FF FF DC 2B",
       "01 17 10 30 39 00 00 00 00 00 00 00 00 00 00 01 F4 00 00 0C A5",
       [](ModbusPort& port) {
         const std::array<std::uint16_t, 2> force{0xFE0C, 0xFFFF};
         std::array<std::uint16_t, 8> words{};
         EXPECT_EQ(port.exchange(28, force, 342, words), PortFault::None);
       }},
      {"ORCA, position",
       "01 03 01 56 00 02 25 E7",
       "01 03 04 30 39 00 00 25 3E",
       reads(342, {12'345, 0})},
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
      {"AZ, detected position",
       "01 03 00 CC 00 02 04 34",
       "01 03 04 00 00 03 E8 FA 8D",
       reads(0xCC, {0, 1000})},
      {"AZ, direct data operation",
       "01 10 00 58 00 10 20 00 00 00 00 00 00 00 01 00 00 03 E8 00 00 07 D0 00 00 05 DC 00 00 05 "
       "DC 00 00 03 E8 00 00 00 01 6D D1",
       "01 10 00 58 00 10 40 16",
       writes(0x58, {0, 0, 0, 1, 0, 1000, 0, 2000, 0, 1500, 0, 1500, 0, 1000, 0, 1})},
      {"TLB4, all in one",
       "01 03 00 05 00 09 95 CD",
       "01 03 12 00 00 00 00 00 00 00 C8 00 00 00 00 00 00 00 00 00 00 24 E1",
       reads(5, {0, 0, 0, 200, 0, 0, 0, 0, 0})},
      {"TLB4, gross", "01 03 00 07 00 02 75 CA", "01 03 04 00 00 00 C8 FB A5", reads(7, {0, 200})},
      {"Z-SG, net weight",
       "01 03 00 3F 00 02 F4 07",
       "01 03 04 3F C0 00 00 F6 1B",
       reads(63, {0x3FC0, 0})},
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

}  // namespace
}  // namespace palp::io
