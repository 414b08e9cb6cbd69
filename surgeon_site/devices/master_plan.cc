#include "surgeon_site/devices/master_plan.h"

#include <algorithm>

#include "surgeon_site/devices/force_feedback_board.h"
#include "surgeon_site/devices/paddle.h"

namespace palp::surgeon {

const std::vector<KnownMaster>& known_masters() {
  static const std::vector<KnownMaster> all{
      {MasterKind::Board, "openffboard", "OpenFFBoard", true},
      {MasterKind::Paddle, "paddle", "Teensy paddle", true},
      {MasterKind::SpaceMouse, "spacemouse", "3Dconnexion SpaceMouse", false}};
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
  const auto models = SpaceMouse::addresses();
  return {models.begin(), models.end()};
}

std::unique_ptr<MasterProtocol> make_protocol(const MasterPlan& plan) {
  if (plan.product->kind == MasterKind::Board) {
    return std::make_unique<ForceFeedbackBoard>(plan.pedal_button);
  }
  if (plan.product->kind == MasterKind::Paddle) return std::make_unique<Paddle>();
  return std::make_unique<SpaceMouse>(plan.rates);
}

}  // namespace palp::surgeon
