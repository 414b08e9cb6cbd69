// Each fault of each Modbus product: the state it leads to, the time that takes, and how far the
// axis goes on. The rows stand in docs/hardware.md, and are measured here in virtual time.
#include <cstdio>
#include <functional>
#include <utility>

#include <gtest/gtest.h>

#include "tests/patient_site/devices/drive_model.h"
#include "tests/support/fault_rows.h"
#include "tests/support/random_runs.h"

namespace palp::patient {
namespace {

using io::PortFault;

struct Fault {
  std::string name;
  std::string only;  ///< of these products; empty: of all
  std::function<void(DriveModel&)> make;
  std::string state;       ///< "absent: no reply"
  double further{0.0025};  ///< [m], how far it may go on
  bool from_the_start{};   ///< made before the device was ever ready
  double within_ms{400};
};

std::vector<Fault> faults_of_lines() {
  const auto port = [](PortFault fault) {
    return [fault](DriveModel& device) { device.port.fault = fault; };
  };
  return {
      {"no reply", "", port(PortFault::NoReply), "absent: no reply"},
      {"broken frames", "", port(PortFault::BrokenFrame), "absent: broken frame"},
      {"another station answers",
       "",
       port(PortFault::WrongStation),
       "absent: another station answered"},
      {"exception reply", "", port(PortFault::Refused), "fault: request refused"},
      {"unplugged",
       "",
       [](DriveModel& device) {
         device.port.fault = PortFault::Lost;
         device.port.openable = false;
       },
       "absent: connection lost"},
  };
}

std::vector<Fault> faults_of_devices() {
  return {
      {"emergency stop",
       "iai",
       [](DriveModel& device) { device.port.words[0x9005] = 0xB010; },
       "fault: the device reports: emergency stop"},
      {"watchdog of the drive",
       "orca",
       [](DriveModel& device) { device.port.words[432] = 0x0800; },
       "fault: the device reports: the drive's watchdog has stopped it"},
      {"position jumps by 40 mm",
       "iai orca az",
       [](DriveModel& device) { device.offset = 0.04; },
       "fault: the position jumped"},
      {"word order turns",
       "iai orca az",
       [](DriveModel& device) { device.swapped = true; },
       "fault: the position jumped"},
      {"wrong word order",
       "iai orca az",
       [](DriveModel& device) { device.swapped = true; },
       "fault: its position is far outside its travel: are unit and word order the device's?",
       0.0,
       true},
      {"who commands falls silent",
       "iai orca az",
       [](DriveModel& device) { device.alive = false; },
       "ready: ",
       0.0101},
      {"force saturated",
       "tlb4 z-sg orca",
       [](DriveModel& device) { device.force = 60; },
       "ready, saturated: ",
       1},
      {"force saturated at the start",
       "tlb4 z-sg orca",
       [](DriveModel& device) { device.force = 60; },
       "fault: the reading is at the end of its range",
       1,
       true},
      {"force stuck",
       "tlb4 z-sg orca",
       [](DriveModel& device) { device.quiet = true; },
       "fault: the reading is stuck",
       0.04},
      {"force is no number",
       "z-sg",
       [](DriveModel& device) { device.no_number = true; },
       "fault: a reading is no number"},
  };
}

std::string state_of(const DriveModel& device) {
  return std::string{to_string(device.reading.state)} +
         (device.reading.saturated && device.reading.state == DeviceState::Ready ? ", saturated"
                                                                                 : "") +
         ": " + device.why();
}

void stand_still(DriveModel& device) {
  for (double before = -1; before != device.place(); device.cycles(1)) before = device.place();
}

class RegisterFaultTest : public testing::TestWithParam<std::string> {};

TEST_P(RegisterFaultTest, EachEndsWhereTheTableSaysInTimeAndWithoutARunaway) {
  std::vector<Fault> faults = faults_of_lines();
  for (const Fault& one : faults_of_devices()) faults.push_back(one);
  int rows = 0;
  for (const Fault& fault : faults) {
    if (!fault.only.empty() && fault.only.find(GetParam()) == std::string::npos) continue;
    DriveModel device{GetParam()};
    if (!fault.from_the_start) {
      ASSERT_EQ(device.cycles(60).state, DeviceState::Ready) << device.why();
      device.move(0.08);
      device.cycles(20);
    }
    const double before = device.place();
    const TimePoint made = device.clock.at;
    fault.make(device);
    while (state_of(device) != fault.state && device.clock.at - made < std::chrono::seconds{2}) {
      device.cycles(1);
    }
    ASSERT_EQ(state_of(device), fault.state) << fault.name;
    if (device.axis() && !device.alive) stand_still(device);
    const double after_ms = seconds(device.clock.at - made) * 1e3;
    EXPECT_LE(after_ms, fault.within_ms) << fault.name;
    device.cycles(60);
    const double further = std::abs(device.place() - before);
    EXPECT_LE(further, fault.further) << fault.name;
    std::array<char, 32> beyond{"-"};
    if (device.axis() && fault.further < 1) {
      (void)std::snprintf(beyond.data(), beyond.size(), "%.1f mm", further * 1e3);
    }
    const std::string row = fault_row(
        device.profile().name, fault.name, in_words(fault.state), after_ms, beyond.data());
    EXPECT_TRUE(is_documented(row)) << row;
    ++rows;
  }
  EXPECT_EQ(rows, documented_rows(find_profile(GetParam())->name));
}

TEST_P(RegisterFaultTest, EveryThirdAnswerIsEnoughToMoveAndToFeel) {
  for (const PortFault bad :
       {PortFault::NoReply, PortFault::BrokenFrame, PortFault::WrongStation}) {
    DriveModel device{GetParam()};
    ASSERT_EQ(device.cycles(60).state, DeviceState::Ready) << device.why();
    device.move(0.04);
    double before = device.place();
    const std::uint64_t heard = device.reading.number;
    for (int i = 0; i < 450; ++i) {
      device.port.fault = i % 3 != 0 ? bad : PortFault::None;
      device.cycles(1);
      const double most = DriveModel::kSpeed * seconds(device.profile().period) + 1e-4;
      ASSERT_LE(std::abs(std::exchange(before, device.place()) - device.place()), most);
    }
    EXPECT_EQ(device.reading.state, DeviceState::Ready) << device.why();
    EXPECT_GE(device.reading.failures, 300U);
    EXPECT_GE(device.reading.number - heard, 150U);
    EXPECT_NEAR(device.place(), device.axis() ? 0.04 : 0, 1e-4);
  }
}

TEST_P(RegisterFaultTest, APlaceThatJumpsToAndFroAtTheLimitIsFound) {
  DriveModel device{GetParam()};
  if (!device.axis()) return;
  ASSERT_EQ(device.cycles(60).state, DeviceState::Ready) << device.why();
  const double most = 3 * DriveModel::kSpeed * seconds(device.profile().period) + 1.9e-3;
  device.offset = most;
  EXPECT_EQ(device.cycles(1).state, DeviceState::Ready) << "one late stamp might do that";
  device.offset = 0;
  EXPECT_EQ(device.cycles(1).state, DeviceState::Fault);
  EXPECT_EQ(device.why(), "the position jumped");
}

TEST_P(RegisterFaultTest, NoSequenceOfThemMakesItJumpOrLeaveItsTravel) {
  for (std::uint64_t run = 0; run < 1000; ++run) {
    const RandomStream stream = random_run(19, run);
    std::uint64_t index = 0;
    const auto draw = [&](std::uint64_t count) { return stream.bits(index++) % count; };
    DriveModel device{GetParam()};
    device.cycles(25);
    double offset_most = 0;
    for (int i = 0; i < 6; ++i) {
      const double before = device.place();
      device.move(static_cast<double>(draw(600)) * 1e-3 - 0.3);
      device.port.fault = draw(3) == 0 ? static_cast<PortFault>(draw(8)) : PortFault::None;
      device.port.openable = draw(3) != 0;
      device.swapped = draw(12) == 0;
      device.quiet = draw(8) == 0;
      device.no_number = draw(8) == 0;
      device.force = draw(6) == 0 ? 60 : 0;
      device.offset = draw(8) == 0 ? static_cast<double>(draw(100)) * 1e-3 : 0;
      offset_most = std::max(offset_most, device.offset);
      device.alive = draw(4) != 0;
      if (GetParam() == "iai") device.port.words[0x9005] = draw(6) == 0 ? 0xB010 : 0x3010;
      if (GetParam() == "orca") device.port.words[432] = draw(6) == 0 ? 0x0800 : 0;
      device.command.asks.restarts += static_cast<std::uint32_t>(draw(2));
      device.command.asks.tares += static_cast<std::uint32_t>(draw(2));
      const auto count = static_cast<int>(1 + draw(20));
      if (draw(6) == 0) device.clock.at += std::chrono::milliseconds{draw(700)};
      device.cycles(count);
      ASSERT_TRUE(std::isfinite(device.reading.force)) << run;
      ASSERT_TRUE(std::isfinite(device.reading.position)) << run;
      if (!device.axis()) continue;
      const double span = count * seconds(device.profile().period);
      ASSERT_LE(std::abs(device.place() - before), DriveModel::kSpeed * span + 1e-4) << run;
      ASSERT_LE(std::abs(device.place()), 0.101 + offset_most) << run;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Products,
                         RegisterFaultTest,
                         testing::Values("iai", "orca", "az", "tlb4", "z-sg"),
                         [](const auto& one) {
                           return one.param == "z-sg" ? std::string{"zsg"} : one.param;
                         });

}  // namespace
}  // namespace palp::patient
