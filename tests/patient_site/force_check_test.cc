// A person, a weight and a sensor that nobody has calibrated: 3 N unloaded. In virtual time.
#include "patient_site/force_check.h"

#include <sstream>

#include <gtest/gtest.h>

#include "tests/patient_site/devices/card_bench.h"
#include "tests/patient_site/devices/drive_model.h"

namespace palp::patient {
namespace {

constexpr double kUnloaded = 3;  // [N]
constexpr const char* kAnswers = "\n5\n\n";

/// [N], on the sensor, by what the person was asked for last.
double load_after(const std::string& said) {
  const bool loaded = said.find("Scale.") != std::string::npos;
  const bool taken_away = said.find("Take the weight away.") != std::string::npos;
  return kUnloaded + (loaded && !taken_away ? 5 : 0);
}

TEST(CellCheckTest, TheZeroOfANewCellIsFoundWhereverItIs) {
  DriveModel cell{"tlb4"};
  cell.force = kUnloaded;
  DevicePlan plan;
  plan.profile = cell.profile();
  plan.installation = DriveModel::installation();
  std::istringstream in{kAnswers};
  std::ostringstream out;
  site_program::Dialogue talk{in, out};
  const auto pass = [&](Duration span) {
    cell.force = load_after(out.str());
    cell.pass(span);
  };
  const auto found = check_cell(plan, cell.port, cell.clock, pass, talk);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_NEAR(found->installation.force_zero, kUnloaded, 0.01);
  EXPECT_EQ(found->installation.force_unit, 0) << "the profile's";
  EXPECT_EQ(found->installation.tare_within, plan.installation.tare_within) << "the file's";
}

class CardCheckTest : public CardBench {};

TEST_F(CardCheckTest, TheZeroOfANewSensorAtACardIsFoundWhereverItIs) {
  CardPlan plan;
  plan.installation = card_built_in(CardKind::Usb1608);
  ScanCard::Ports ports;
  for (const auto& one : ports_) ports.push_back(one.get());
  std::istringstream in{kAnswers};
  std::ostringstream out;
  site_program::Dialogue talk{in, out};
  const auto pass = [&](Duration span) {
    constexpr double kCountsPerNewton = 32768.0 / 10 / 5;
    clock_.at += span;
    packet(0x8000 + static_cast<int>(load_after(out.str()) * kCountsPerNewton));
  };
  const auto found = check_card(plan, ports, clock_, pass, talk);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_NEAR(found->installation.load.force_zero, kUnloaded, 0.01);
  EXPECT_EQ(found->installation.newtons_per_volt, 5);
  EXPECT_EQ(found->installation.load.tare_within, plan.installation.load.tare_within);
}

}  // namespace
}  // namespace palp::patient
