#include "surgeon_site/devices/master_rig.h"

#include <utility>

namespace palp::surgeon {
namespace {

constexpr Duration kMasterReachPatience = std::chrono::seconds{5};
constexpr Duration kMasterStartPatience = std::chrono::seconds{10};

}  // namespace

MasterRig::MasterRig(const MasterPlan& plan, int priority)
    : product_{plan.product->name},
      thread_{"master", make_protocol(plan), plan.installation, make_port(plan), priority},
      device_{thread_, plan.facts} {}

std::string MasterRig::sentence() {
  const MasterReading& reading = thread_.status();
  std::string text =
      thread_.name() + " (" + product_ + "): " + std::string{to_string(reading.state)};
  return reading.why.empty() ? text : text + ", " + std::string{reading.why};
}

std::optional<std::string> MasterRig::hopeless(Duration waited) {
  const MasterState state = thread_.status().state;
  if (state == MasterState::Ready) return std::nullopt;
  const Duration patience =
      state == MasterState::Absent ? kMasterReachPatience : kMasterStartPatience;
  if (state == MasterState::Fault || waited >= patience) return sentence();
  return std::nullopt;
}

std::optional<std::uint32_t> MasterRig::take_answer() {
  const MasterReading& reading = thread_.status();
  if (std::exchange(answers_, reading.answers) == reading.answers) return std::nullopt;
  return reading.answer;
}

std::optional<MasterNews> MasterRig::news() {
  const MasterReading& reading = thread_.status();
  const bool same_state = std::exchange(state_, reading.state) == reading.state;
  const bool same_why = std::exchange(why_, reading.why) == reading.why;
  if (same_state && same_why) return std::nullopt;
  return MasterNews{sentence(), reading.why.empty()};
}

}  // namespace palp::surgeon
