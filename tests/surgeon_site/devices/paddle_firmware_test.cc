// The paddle's sketch, compiled here between stand-ins for the board's functions.
#include <array>
#include <cstdint>
#include <deque>

#include <gtest/gtest.h>

#include "surgeon_site/devices/firmware/paddle/paddle_report.h"

namespace {

using Report = std::array<std::uint8_t, palp_paddle::kReportBytes>;

// The board's own names.
// NOLINTBEGIN(readability-identifier-naming)
constexpr int LOW = 0;
constexpr int HIGH = 1;
constexpr int INPUT_PULLUP = 2;
constexpr int OUTPUT = 3;
constexpr int CHANGE = 4;

/// The board.
struct Board {
  std::uint64_t us{};
  std::array<int, 16> pins{};
  std::array<int, 16> duty{};
  std::deque<Report> from_host;
  std::deque<Report> to_host;
  void (*interrupt)() = nullptr;
} board;

int digitalRead(int pin) { return board.pins.at(static_cast<std::size_t>(pin)); }
void digitalWrite(int pin, int level) { board.pins.at(static_cast<std::size_t>(pin)) = level; }
void analogWrite(int pin, int duty) { board.duty.at(static_cast<std::size_t>(pin)) = duty; }
void pinMode(int /*pin*/, int /*mode*/) {}
int digitalPinToInterrupt(int pin) { return pin; }
void attachInterrupt(int /*pin*/, void (*handler)(), int /*mode*/) { board.interrupt = handler; }
std::uint32_t micros() { return static_cast<std::uint32_t>(board.us); }
std::uint32_t millis() { return static_cast<std::uint32_t>(board.us / 1000); }

struct {
  int recv(std::uint8_t* report, int /*wait_ms*/) {
    if (board.from_host.empty()) return 0;
    std::copy(board.from_host.front().begin(), board.from_host.front().end(), report);
    board.from_host.pop_front();
    return static_cast<int>(palp_paddle::kReportBytes);
  }
  int send(const std::uint8_t* report, int /*wait_ms*/) {
    Report copy{};
    std::copy_n(report, copy.size(), copy.begin());
    board.to_host.push_back(copy);
    return 1;
  }
} RawHID;
// NOLINTEND(readability-identifier-naming)

// Twice: as it comes, and as somebody calibrated it.
namespace plain {
#include "surgeon_site/devices/firmware/paddle/paddle.ino"
}  // namespace plain
namespace calibrated {
#undef PADDLE_NANOMETRES_PER_COUNT
#undef PADDLE_DUTY_PER_NEWTON
#define PADDLE_NANOMETRES_PER_COUNT 10'000
#define PADDLE_DUTY_PER_NEWTON 100
#include "surgeon_site/devices/firmware/paddle/paddle.ino"
}  // namespace calibrated

palp_paddle::State newest() {
  palp_paddle::State told{};
  EXPECT_TRUE(palp_paddle::unpack(board.to_host.back().data(), board.to_host.back().size(), told));
  return told;
}

void say(std::uint16_t flags, std::uint16_t valid_for_ms) {
  palp_paddle::Command words{};
  words.flags = flags;
  words.force_un = 1'000'000;
  words.valid_for_ms = valid_for_ms;
  words.sequence = 7;
  Report report{};
  palp_paddle::pack(words, report.data());
  board.from_host.push_back(report);
}

void run_for_ms(int span, void (*loop)() = plain::loop) {
  for (int i = 0; i < 4 * span; ++i) {
    board.us += 250;
    loop();
  }
}

TEST(PaddleFirmwareTest, TellsItsStateEachMillisecondAndWhenTheHostsWordRanOut) {
  board = {};
  plain::setup();
  board.pins.at(7) = HIGH;
  run_for_ms(10);
  EXPECT_NEAR(static_cast<double>(board.to_host.size()), 10, 1);
  EXPECT_EQ(newest().flags, palp_paddle::kStateCommandExpired) << "and it is not calibrated";
  say(palp_paddle::kCommandEnable | palp_paddle::kCommandLamp, 20);
  board.pins.at(7) = LOW;
  run_for_ms(10);
  EXPECT_EQ(newest().flags, palp_paddle::kStatePedalHeld);
  EXPECT_EQ(newest().command_sequence, 7);
  EXPECT_EQ(board.pins.at(13), HIGH);
  run_for_ms(11);
  EXPECT_EQ(newest().flags, palp_paddle::kStatePedalHeld | palp_paddle::kStateCommandExpired);
  EXPECT_EQ(board.pins.at(13), LOW);
  board.pins.at(6) = HIGH;
  board.from_host.push_back(Report{});
  run_for_ms(2);
  EXPECT_NE(newest().flags & palp_paddle::kStateEmergencyStop, 0);
  EXPECT_NE(newest().flags & palp_paddle::kStateBadCommand, 0);
  EXPECT_EQ(board.duty.at(4), 0) << "a paddle without calibration does not push";
}

TEST(PaddleFirmwareTest, PushesAsLongAsTheHostSaysAndNeverAgainOnAnOldWord) {
  board = {};
  calibrated::setup();
  say(palp_paddle::kCommandEnable, 20);
  run_for_ms(10, calibrated::loop);
  EXPECT_EQ(board.duty.at(4), 100) << "one newton";
  run_for_ms(11, calibrated::loop);
  EXPECT_EQ(board.duty.at(4), 0);
  constexpr std::uint64_t kHalfOfTheClock = std::uint64_t{1} << 31U;  // [ms], 24.9 days
  board.us += kHalfOfTheClock * 1000;
  run_for_ms(2, calibrated::loop);
  EXPECT_EQ(board.duty.at(4), 0) << "its clock came round";
  say(palp_paddle::kCommandEnable, 20);
  run_for_ms(2, calibrated::loop);
  EXPECT_EQ(board.duty.at(4), 100);
  board.pins.at(6) = HIGH;
  run_for_ms(1, calibrated::loop);
  EXPECT_EQ(board.duty.at(4), 0) << "emergency stop";
}

}  // namespace
