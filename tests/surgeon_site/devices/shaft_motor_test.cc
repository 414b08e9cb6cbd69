// The ORCA as a haptic master: what it is told, each of its faults with the state it leads to and
// the time that takes, as docs/hardware.md has them, and random sequences of them. In virtual time.
#include "surgeon_site/devices/shaft_motor.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "common/io/device/hid_port.h"
#include "surgeon_site/devices/master_device.h"
#include "surgeon_site/devices/master_plan.h"
#include "surgeon_site/devices/register_reports.h"
#include "surgeon_site/settings_devices.h"
#include "tests/common/io/device/fake_hidapi.h"
#include "tests/common/io/device/fake_registers.h"
#include "tests/support/fault_rows.h"
#include "tests/support/random_runs.h"

namespace palp::surgeon {
namespace {

using io::PortFault;

/// The drive's registers, and a pedal on USB.
class ShaftBench {
 public:
  ShaftBench() : plan_{plan()} {
    fake_hid::Device made;
    made.path = "pedal";
    made.vendor = 0x05F3;
    made.product = 0x00FF;
    pedal = &fake_hid::plug(made);
    auto owned = std::make_unique<FakeRegisters>();
    registers = owned.get();
    registers->written = [this](std::uint16_t address) {
      if (address == 3) registers->words[317] = registers->words[3];
      if (address == 0 && registers->words[0] == 2) registers->words[432] = 0;
    };
    port_ = std::make_unique<RegisterReports>(std::move(owned),
                                              std::make_unique<io::HidPort>(plan_.pedal));
    device_ = std::make_unique<MasterDevice>(make_protocol(plan_), plan_.installation, *port_);
  }
  ~ShaftBench() {
    port_.reset();
    fake_hid::clear();
  }
  ShaftBench(const ShaftBench&) = delete;
  ShaftBench& operator=(const ShaftBench&) = delete;

  static MasterPlan plan() {
    return make_master_plan(*master_named("orca"),
                            "master { address: \"tcp:127.0.0.1:5020\" "
                            "zero_mm: 60 travel_min_mm: -60 force_max_n: 20 "
                            "pedal { vendor: 1523 product: 255 byte: 1 mask: 2 } "
                            "answer { button: 0 } answer { button: 10 } }",
                            "hand")
        .value();
  }
  MasterReading step(double force) {
    clock.at += plan_.installation.period;
    place_at(place);
    if (heard) {
      command.force = force;
      command.valid_until = clock.at + std::chrono::milliseconds{20};
    }
    return reading = device_->cycle(clock, command);
  }
  MasterReading steps(int count, double force) {
    for (int i = 0; i < count; ++i) (void)step(force);
    return reading;
  }
  /// [N], as the drive has it.
  [[nodiscard]] double asked() {
    const std::uint32_t bits = registers->words[28] | (std::uint32_t{registers->words[29]} << 16U);
    return registers->words[3] == 2 ? static_cast<std::int32_t>(bits) * 1e-3 : 0;
  }
  [[nodiscard]] std::string state() const {
    return std::string{to_string(reading.state)} + ": " + std::string{reading.why};
  }
  void stop() { device_->stop(); }

  FakeRegisters* registers{};
  fake_hid::Device* pedal{};
  TestClock clock;
  MasterCommand command;
  MasterReading reading;
  double place{0.06};  ///< [m], of the shaft
  bool heard{true};

 private:
  void place_at(double metres) {
    const auto um =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(metres * 1e6)));
    registers->words[342] = static_cast<std::uint16_t>(um & 0xFFFFU);
    registers->words[343] = static_cast<std::uint16_t>(um >> 16U);
  }

  MasterPlan plan_;
  std::unique_ptr<RegisterReports> port_;
  std::unique_ptr<MasterDevice> device_;
};

TEST(ShaftMotorTest, StartsWithItsWatchdogAndItsCeilingAndThenGivesForce) {
  ShaftBench shaft;
  ASSERT_EQ(shaft.steps(40, 0).state, MasterState::Ready) << shaft.state();
  EXPECT_EQ(shaft.registers->words[163], 50) << "ms";
  EXPECT_EQ(shaft.registers->words[140], 20'000) << "mN";
  EXPECT_EQ(shaft.registers->words[3], 2) << "control of force";
  EXPECT_NEAR(shaft.reading.position, 0, 1e-9);
  shaft.place = 0.058;
  (void)shaft.steps(10, -1.5);
  EXPECT_NEAR(shaft.asked(), -1.5, 1e-9);
  EXPECT_NEAR(shaft.reading.position, -0.002, 1e-9);
  EXPECT_EQ(shaft.steps(1, 70).force, 20) << "no more than it may";
}

TEST(ShaftMotorTest, TheAnswerToACommandIsTheReadingOfThatVeryCycle) {
  ShaftBench shaft;
  (void)shaft.steps(40, 0);
  shaft.place = 0.061;
  EXPECT_NEAR(shaft.step(0.7).position, 0.001, 1e-9);
  EXPECT_NEAR(shaft.asked(), 0.7, 1e-9);
}

TEST(ShaftMotorTest, ThePedalIsABitOfTheOtherDevicesReports) {
  ShaftBench shaft;
  (void)shaft.steps(40, 0);
  EXPECT_FALSE(shaft.reading.pedal_held);
  shaft.pedal->input.push_back({0, 3});
  EXPECT_TRUE(shaft.step(0).pedal_held);
  shaft.pedal->input.push_back({9});
  EXPECT_TRUE(shaft.step(0).pedal_held) << "a short report says nothing";
  shaft.pedal->input.push_back({0, 1});
  EXPECT_FALSE(shaft.step(0).pedal_held);
  const std::uint64_t before = shaft.reading.number;
  shaft.pedal->input.push_back({0, 1});
  EXPECT_EQ(shaft.step(0).number, before + 1) << "it is no reading of the shaft";
}

// A pedal of three switches: one engages, two answer.
TEST(ShaftMotorTest, FurtherBitsOfThePedalAnswer) {
  ShaftBench shaft;
  (void)shaft.steps(40, 0);
  shaft.pedal->input.push_back({0, 2});
  EXPECT_EQ(shaft.step(0).answers, 0U);
  shaft.pedal->input.push_back({1, 2});
  EXPECT_EQ(shaft.step(0).answer, 1U);
  shaft.pedal->input.push_back({0, 6});
  EXPECT_EQ(shaft.step(0).answer, 2U);
  EXPECT_EQ(shaft.reading.answers, 2U);
  EXPECT_TRUE(shaft.reading.pedal_held);
}

TEST(ShaftMotorTest, OnTheWayOutItSleeps) {
  ShaftBench shaft;
  (void)shaft.steps(40, 2);
  shaft.stop();
  EXPECT_EQ(shaft.registers->words[28], 0);
  EXPECT_EQ(shaft.registers->words[3], 1);
}

TEST(ShaftMotorTest, ALineThatComesBackClearsItsWatchdogAndNothingElse) {
  for (const int errors : {0x0800, 0x0840}) {
    ShaftBench shaft;
    (void)shaft.steps(40, 0);
    shaft.registers->fault = PortFault::Lost;
    ASSERT_EQ(shaft.steps(3, 0).state, MasterState::Absent);
    shaft.registers->fault = PortFault::None;
    shaft.registers->words[432] = static_cast<std::uint16_t>(errors);
    (void)shaft.steps(700, 0);
    EXPECT_EQ(shaft.state(), errors == 0x0800 ? "ready: " : "fault: it is too hot");
    if (errors == 0x0800) continue;
    ++shaft.command.restarts;
    EXPECT_EQ(shaft.steps(60, 0).state, MasterState::Ready) << shaft.state();
  }
}

struct Fault {
  std::string name;
  std::function<void(ShaftBench&)> make;
  std::string state;
};

std::vector<Fault> faults() {
  const auto port = [](PortFault fault) {
    return [fault](ShaftBench& shaft) { shaft.registers->fault = fault; };
  };
  const auto errors = [](std::uint16_t bits) {
    return [bits](ShaftBench& shaft) { shaft.registers->words[432] = bits; };
  };
  return {{"no reply", port(PortFault::NoReply), "absent: it fell silent"},
          {"broken frames", port(PortFault::BrokenFrame), "absent: it fell silent"},
          {"another station answers", port(PortFault::WrongStation), "absent: it fell silent"},
          {"exception reply", port(PortFault::Refused), "absent: it fell silent"},
          {"unplugged", port(PortFault::Lost), "absent: connection lost"},
          {"pedal unplugged",
           [](ShaftBench& shaft) { shaft.pedal->there = false; },
           "absent: its pedal is gone"},
          {"watchdog of the drive", errors(0x0800), "fault: its watchdog has stopped it"},
          {"too hot", errors(0x0040), "fault: it is too hot"},
          {"leaves the control of its force",
           [](ShaftBench& shaft) { shaft.registers->words[317] = 1; },
           "fault: it has left the control of its force"},
          {"position jumps by 10 mm",
           [](ShaftBench& shaft) { shaft.place -= 0.01; },
           "fault: the position jumped"},
          {"who commands falls silent", [](ShaftBench& shaft) { shaft.heard = false; }, "ready: "}};
}

TEST(ShaftMotorTest, EachFaultEndsWhereTheTableSaysInTimeAndWithoutForce) {
  for (const Fault& fault : faults()) {
    ShaftBench shaft;
    ASSERT_EQ(shaft.steps(60, 1.5).state, MasterState::Ready) << shaft.state();
    ASSERT_EQ(shaft.reading.force, 1.5);
    fault.make(shaft);
    int after = 0;
    do {
      (void)shaft.step(1.5);
      ++after;
    } while (after < 1000 && (shaft.state() != fault.state || shaft.reading.force != 0));
    ASSERT_EQ(shaft.state(), fault.state) << fault.name;
    const bool told = shaft.registers->fault == PortFault::None;
    for (int i = 0; i < 100; ++i) {
      ASSERT_EQ(shaft.step(1.5).force, 0) << fault.name;
      ASSERT_EQ(told ? shaft.asked() : 0, 0) << fault.name;
    }
    const std::string row =
        fault_row("Iris ORCA as a master", fault.name, in_words(fault.state), after, "0 N");
    EXPECT_TRUE(is_documented(row)) << row;
  }
  EXPECT_EQ(faults().size(), static_cast<std::size_t>(documented_rows("Iris ORCA as a master")));
}

TEST(ShaftMotorTest, NoSequenceOfThemGivesForceThatIsNotAskedFor) {
  ShaftBench shaft;
  for (std::uint64_t run = 0; run < 1000; ++run) {
    const RandomStream stream = random_run(21, run);
    std::uint64_t index = 0;
    const auto draw = [&](std::uint64_t count) { return stream.bits(index++) % count; };
    for (int i = 0; i < 12; ++i) {
      shaft.registers->fault = draw(4) == 0 ? static_cast<PortFault>(draw(8)) : PortFault::None;
      shaft.registers->openable = draw(6) != 0;
      shaft.pedal->there = draw(8) != 0;
      if (draw(6) == 0) shaft.registers->words[432] = static_cast<std::uint16_t>(1U << draw(14));
      if (draw(9) == 0) shaft.registers->words[317] = static_cast<std::uint16_t>(draw(6));
      if (draw(3) == 0) shaft.pedal->input.push_back({0, static_cast<std::uint8_t>(draw(4))});
      if (draw(6) == 0) shaft.place = static_cast<double>(draw(160)) * 1e-3 - 0.02;
      if (draw(10) == 0) shaft.clock.at += std::chrono::milliseconds{draw(700)};
      if (draw(4) == 0) ++shaft.command.restarts;
      shaft.heard = draw(4) != 0;
      const double asked = draw(20) == 0 ? std::nan("") : static_cast<double>(draw(60)) - 30;
      const bool heard = shaft.heard;
      const MasterReading reading = shaft.step(asked);
      ASSERT_TRUE(reading.state == MasterState::Ready || reading.force == 0) << run;
      const double most = !heard ? 20 : std::isfinite(asked) ? std::abs(asked) : 0;
      ASSERT_LE(std::abs(reading.force), most) << run;
      ASSERT_TRUE(std::isfinite(reading.position)) << run;
      ASSERT_LE(std::abs(reading.velocity), 3.0) << run;
      if (shaft.registers->fault != PortFault::None) continue;
      ASSERT_LE(std::abs(shaft.asked()), 20.0) << run;
    }
  }
}

TEST(ShaftMotorTest, ASlowLineMakesASlowMasterThatSaysSo) {
  const auto plan = [](const std::string& baud) {
    return make_master_plan(
               *master_named("orca"),
               "master { address: \"serial:/dev/a\" baud: " + baud + " pedal { vendor: 1 } }",
               "hand")
        .value();
  };
  EXPECT_NEAR(plan("115200").facts.rate, 115'200 / 418.0, 0.1);
  EXPECT_EQ(plan("1000000").facts.rate, 1000);
  EXPECT_GT(plan("19200").installation.silence, std::chrono::milliseconds{120});
}

TEST(ShaftMotorTest, WithoutAPedalOrALineItIsRefused) {
  const auto refusal = [](const char* text) {
    const auto made = make_master_plan(*master_named("orca"), text, "hand");
    return made ? "accepted" : made.error().text;
  };
  EXPECT_NE(refusal("").find("is no address of a device"), std::string::npos) << refusal("");
  const char* const alone = "master { address: \"tcp:1.2.3.4:5\" }";
  EXPECT_NE(refusal(alone).find("a pedal is missing"), std::string::npos) << refusal(alone);
}

}  // namespace
}  // namespace palp::surgeon
