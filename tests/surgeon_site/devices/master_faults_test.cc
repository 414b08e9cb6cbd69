// Each fault of each haptic master: the state it leads to, the time that takes, and the force that
// its motor is asked for from then on. The rows stand in docs/hardware.md, and are measured here in
// virtual time.
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "surgeon_site/devices/firmware/paddle/paddle_report.h"
#include "surgeon_site/devices/master_plan.h"
#include "surgeon_site/settings_devices.h"
#include "tests/support/fault_rows.h"
#include "tests/support/random_runs.h"
#include "tests/surgeon_site/devices/hid_bench.h"

namespace palp::surgeon {
namespace {

using fake_hid::Bytes;

MasterPlan plan_of(const std::string& flag) {
  return make_master_plan(*master_named(flag), "master { um_per_count: 1 mn_per_count: 1 }", "hand")
      .value();
}

/// A master's far end: what it reports each millisecond, of its own product.
class FarEnd {
 public:
  explicit FarEnd(const std::string& flag)
      : plan_{plan_of(flag)},
        bench_{make_protocol(plan_), addresses_of(plan_.product->kind)[0], installation()} {
    const io::HidAddress address = addresses_of(plan_.product->kind)[0];
    fake_hid::Device made;
    made.path = "master";
    made.vendor = address.vendor;
    made.product = address.product;
    made.interface_number = std::max(0, address.interface_number);
    made.usage_page = address.usage_page;
    raw = &fake_hid::plug(made);
    raw->feature = [](std::uint8_t id) { return id == 0x12 ? Bytes{0x12, 1, 1, 0, 0} : Bytes{}; };
  }
  MasterReading step(double force) {
    if (talks) report();
    return heard ? bench_.step(force) : bench_.step_unheard();
  }
  [[nodiscard]] bool has_force() const { return plan_.product->force; }
  [[nodiscard]] std::string name() const { return std::string{plan_.product->name}; }
  void restart() { ++bench_.command.restarts; }
  void pass_over(int ms) { bench_.clock.at += std::chrono::milliseconds{ms}; }

  fake_hid::Device* raw{};
  bool talks{true};
  bool frozen{};         ///< its program hangs, and its buffer is sent on
  bool heard{true};      ///< the site goes on commanding
  bool fit{true};        ///< no emergency stop
  bool power{true};      ///< of the motor; not too hot
  double position{};     ///< [m]
  std::size_t length{};  ///< [bytes], of reports that are none; 0: good ones

 private:
  [[nodiscard]] MasterInstallation installation() const {
    MasterInstallation made = plan_.installation;
    if (plan_.product->kind == MasterKind::Paddle) {
      made.position_unit = 1e-9;
      made.force_unit = 1e-6;
    }
    return made;
  }
  void report() {
    if (length > 0) return raw->input.push_back(Bytes(length, 7));
    switch (plan_.product->kind) {
      case MasterKind::Board: {
        Bytes axes(25);
        axes[0] = 1;
        const auto counts =
            static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(position * 1e6)));
        axes[9] = static_cast<std::uint8_t>(counts & 0xFFU);
        axes[10] = static_cast<std::uint8_t>(counts >> 8U);
        raw->input.push_back(axes);
        raw->input.push_back({2, static_cast<std::uint8_t>(2 | (fit ? 4 : 0) | (power ? 8 : 0))});
        return;
      }
      case MasterKind::Paddle: {
        palp_paddle::State state{};
        state.sequence = frozen ? sequence_ : ++sequence_;
        state.position_nm = static_cast<std::int32_t>(std::lround(position * 1e9));
        state.flags = static_cast<std::uint16_t>(palp_paddle::kStateCalibrated |
                                                 (fit ? 0 : palp_paddle::kStateEmergencyStop) |
                                                 (power ? 0 : palp_paddle::kStateTooHot));
        Bytes bytes(palp_paddle::kReportBytes);
        palp_paddle::pack(state, bytes.data());
        raw->input.push_back(bytes);
        return;
      }
      case MasterKind::SpaceMouse:
        raw->input.push_back({1, 0, 0, 0, 0, 100, 0});
        return;
      case MasterKind::ShaftMotor:
        return;  // no device on USB: shaft_motor_test.cc
    }
  }

  MasterPlan plan_;
  MasterBench bench_;
  std::uint16_t sequence_{};
};

struct Fault {
  std::string name;
  std::string only;  ///< of these products; empty: of all
  std::function<void(FarEnd&)> make;
  std::string state;
  double force{};  ///< [N], asked of the motor from then on
};

std::vector<Fault> faults() {
  return {
      {"no reports",
       "paddle openffboard",
       [](FarEnd& far) { far.talks = false; },
       "absent: it fell silent"},
      {"no reports", "spacemouse", [](FarEnd& far) { far.talks = false; }, "ready: "},
      {"unplugged", "", [](FarEnd& far) { far.raw->there = false; }, "absent: connection lost"},
      {"short reports",
       "paddle openffboard",
       [](FarEnd& far) { far.length = 1; },
       "absent: it fell silent"},
      {"long reports",
       "paddle openffboard",
       [](FarEnd& far) { far.length = 70; },
       "absent: it fell silent"},
      {"the same report again and again",
       "paddle",
       [](FarEnd& far) { far.frozen = true; },
       "absent: it fell silent"},
      {"commands cannot be written",
       "paddle openffboard",
       [](FarEnd& far) { far.raw->writable = false; },
       "absent: commands do not reach it"},
      {"emergency stop",
       "paddle openffboard",
       [](FarEnd& far) { far.fit = false; },
       "fault: emergency stop"},
      {"no power",
       "openffboard",
       [](FarEnd& far) { far.power = false; },
       "fault: the actuator has no power"},
      {"too hot", "paddle", [](FarEnd& far) { far.power = false; }, "fault: the motor is too hot"},
      {"position jumps by 10 mm",
       "paddle openffboard",
       [](FarEnd& far) { far.position = -10e-3; },
       "fault: the position jumped"},
      {"who commands falls silent",
       "paddle openffboard",
       [](FarEnd& far) { far.heard = false; },
       "ready: "}};
}

std::string state_of(const MasterReading& reading) {
  return std::string{to_string(reading.state)} + ": " + std::string{reading.why};
}

class MasterFaultTest : public testing::TestWithParam<std::string> {};

TEST_P(MasterFaultTest, EachEndsWhereTheTableSaysInTimeAndWithoutForce) {
  int rows = 0;
  for (const Fault& fault : faults()) {
    if (!fault.only.empty() && fault.only.find(GetParam()) == std::string::npos) continue;
    FarEnd far{GetParam()};
    MasterReading reading;
    for (int i = 0; i < 40; ++i) reading = far.step(1.5);
    ASSERT_EQ(state_of(reading), "ready: ");
    fault.make(far);
    int after = 0;
    const bool stands = GetParam() == "spacemouse";
    do {
      reading = far.step(1.5);
      ++after;
    } while (after < 1000 && (state_of(reading) != fault.state || reading.force != 0 ||
                              (stands && reading.velocity != 0)));
    ASSERT_EQ(state_of(reading), fault.state) << fault.name;
    for (int i = 0; i < 100; ++i) ASSERT_EQ(far.step(1.5).force, 0) << fault.name;
    const std::string row = fault_row(
        far.name(), fault.name, in_words(fault.state), after, far.has_force() ? "0 N" : "-");
    EXPECT_TRUE(is_documented(row)) << row;
    ++rows;
  }
  EXPECT_EQ(rows, documented_rows(FarEnd{GetParam()}.name()));
}

TEST_P(MasterFaultTest, ACableFreesItOfNoFault) {
  FarEnd far{GetParam()};
  if (!far.has_force()) return;  // such a one has no fault
  for (int i = 0; i < 40; ++i) (void)far.step(1.5);
  far.fit = false;
  ASSERT_EQ(far.step(1.5).state, MasterState::Fault);
  far.raw->there = false;
  ASSERT_EQ(far.step(1.5).state, MasterState::Absent);
  far.raw->there = far.fit = true;
  MasterReading reading;
  for (int i = 0; i < 700; ++i) {
    reading = far.step(1.5);
    ASSERT_EQ(reading.force, 0);
  }
  EXPECT_EQ(state_of(reading), "fault: emergency stop");
  far.restart();
  for (int i = 0; i < 40; ++i) reading = far.step(1.5);
  EXPECT_EQ(state_of(reading), "ready: ");
}

TEST_P(MasterFaultTest, NoSequenceOfThemGivesForceThatIsNotAskedFor) {
  FarEnd far{GetParam()};
  for (std::uint64_t run = 0; run < 1000; ++run) {
    const RandomStream stream = random_run(20, run);
    std::uint64_t index = 0;
    const auto draw = [&](std::uint64_t count) { return stream.bits(index++) % count; };
    for (int i = 0; i < 12; ++i) {
      far.talks = draw(4) != 0;
      far.heard = draw(4) != 0;
      far.fit = draw(8) != 0;
      far.power = draw(8) != 0;
      far.raw->there = draw(6) != 0;
      far.raw->writable = draw(6) != 0;
      far.length = draw(6) == 0 ? 1 + draw(90) : 0;
      if (draw(4) == 0) far.position = static_cast<double>(draw(120)) * 1e-3 - 0.06;
      if (draw(10) == 0) far.pass_over(static_cast<int>(draw(700)));
      if (draw(4) == 0) far.restart();
      const double asked = draw(20) == 0 ? std::numeric_limits<double>::quiet_NaN()
                                         : static_cast<double>(draw(9)) - 4;
      const bool heard = far.heard;
      const MasterReading reading = far.step(asked);
      ASSERT_TRUE(reading.state == MasterState::Ready || reading.force == 0) << run;
      ASSERT_LE(std::abs(reading.force), 3.0) << run;
      const double most = heard ? std::abs(std::isfinite(asked) ? asked : 0) : 3.0;
      ASSERT_LE(std::abs(reading.force), far.has_force() ? most : 0.0) << run;
      ASSERT_TRUE(std::isfinite(reading.position)) << run;
      ASSERT_LE(std::abs(reading.velocity), 3.0) << run;
    }
    far.raw->written.clear();
    far.raw->input.clear();
  }
}

INSTANTIATE_TEST_SUITE_P(Products,
                         MasterFaultTest,
                         testing::Values("openffboard", "paddle", "spacemouse"),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace palp::surgeon
