#include "surgeon_site/devices/master_plan.h"

#include <algorithm>

#include "common/io/device/hid_port.h"
#include "surgeon_site/devices/force_feedback_board.h"
#include "surgeon_site/devices/paddle.h"
#include "surgeon_site/devices/register_reports.h"

namespace palp::surgeon {

const std::vector<KnownMaster>& known_masters() {
  static const std::vector<KnownMaster> all{
      {MasterKind::Board, "openffboard", "OpenFFBoard", true},
      {MasterKind::Paddle, "paddle", "Teensy paddle", true},
      {MasterKind::SpaceMouse, "spacemouse", "3Dconnexion SpaceMouse", false},
      {MasterKind::ShaftMotor, "orca", "Iris ORCA", true}};
  return all;
}

const KnownMaster* master_named(std::string_view flag) noexcept {
  const auto& all = known_masters();
  const auto found = std::ranges::find(all, flag, &KnownMaster::flag);
  return found == all.end() ? nullptr : &*found;
}

std::vector<io::HidAddress> addresses_of(MasterKind kind) {
  if (kind == MasterKind::Board) return {ForceFeedbackBoard::address()};
  if (kind == MasterKind::Paddle) return {Paddle::address()};
  if (kind == MasterKind::ShaftMotor) return {};
  const auto models = SpaceMouse::addresses();
  return {models.begin(), models.end()};
}

std::unique_ptr<MasterProtocol> make_protocol(const MasterPlan& plan) {
  if (plan.product->kind == MasterKind::Board) {
    return std::make_unique<ForceFeedbackBoard>(plan.pedal_button, plan.answer_buttons);
  }
  if (plan.product->kind == MasterKind::Paddle) return std::make_unique<Paddle>();
  if (plan.product->kind == MasterKind::ShaftMotor) {
    return std::make_unique<ShaftMotor>(
        plan.installation.force_max, plan.pedal_bit, plan.answer_buttons);
  }
  return std::make_unique<SpaceMouse>(plan.rates, plan.answer_buttons);
}

std::unique_ptr<io::ReportPort> make_port(const MasterPlan& plan) {
  if (plan.product->kind == MasterKind::ShaftMotor) {
    return std::make_unique<RegisterReports>(std::make_unique<io::ModbusPort>(plan.line),
                                             std::make_unique<io::HidPort>(plan.pedal));
  }
  std::vector<io::HidAddress> all = addresses_of(plan.product->kind);
  for (io::HidAddress& one : all) one.serial = plan.serial;
  for (const io::HidFound& found : io::list_hid()) {
    for (const io::HidAddress& one : all) {
      if (agrees(found, one)) return std::make_unique<io::HidPort>(one);
    }
  }
  return std::make_unique<io::HidPort>(all.front());
}

}  // namespace palp::surgeon
