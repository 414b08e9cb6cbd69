#include "patient_site/devices/profile_flaw.h"

#include "patient_site/devices/register_words.h"

namespace palp::patient {

std::optional<std::string> flaw_of(const DeviceProfile& profile,
                                   const DeviceInstallation& installation) {
  if (profile.read_count == 0 || profile.read_count > ReadWords::kCountMax) {
    return profile.name + " reads 1 to 125 registers";
  }
  if (profile.state_count > ReadWords::kCountMax) {
    return profile.name + "'s state has at most 125 registers";
  }
  const ReadWords words{profile.read_address, profile.read_count};
  const ReadWords state{profile.state_address, profile.state_count};
  const auto readable = [&](std::uint16_t address) {
    return words.holds(address, 1) || state.holds(address, 1);
  };
  const auto outside = [&](const char* what) {
    return profile.name + "'s " + what + " is not among the registers that it reads";
  };
  const auto holds = [&](const std::optional<RegisterCondition>& one) {
    return !one || readable(one->address);
  };
  if (!profile.position && !profile.force) return profile.name + " has neither position nor force";
  for (const auto& field : {profile.position, profile.force}) {
    if (field && !words.holds(field->address, words_in(field->kind))) {
      return outside("position or force");
    }
    if (field && field->negative && !words.holds(field->negative->address, 1)) {
      return outside("sign");
    }
  }
  if (profile.life && !words.holds(*profile.life, 1)) return outside("sign of life");
  for (const RegisterCondition& one : profile.healthy) {
    if (!readable(one.address)) return outside("state");
  }
  for (const StartStep& step : profile.start) {
    if (!holds(step.unless) || !holds(step.until) || !holds(step.unasked)) {
      return outside("condition of its start");
    }
  }
  if (!profile.move.empty() && !profile.position) {
    return profile.name + " moves, and has no position";
  }
  if (profile.exchange && profile.move.size() != 1) {
    return profile.name + " exchanges: its move is one request";
  }
  if (installation.travel_min >= installation.travel_max) return profile.name + " has no travel";
  return std::nullopt;
}

}  // namespace palp::patient
