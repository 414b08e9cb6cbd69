#include "patient_site/devices/profile_flaw.h"

#include <algorithm>
#include <cmath>

#include "common/core/printable.h"
#include "patient_site/devices/register_words.h"

namespace palp::patient {
namespace {

using Flaw = std::optional<std::string>;

std::vector<RegisterCondition> conditions_of(const DeviceProfile& profile) {
  std::vector<RegisterCondition> all = profile.healthy;
  const auto add = [&all](const std::optional<RegisterCondition>& one) {
    if (one) all.push_back(*one);
  };
  for (const StartStep& step : profile.start) {
    add(step.unless);
    add(step.until);
    add(step.unasked);
  }
  for (const auto& field : {profile.position, profile.force}) {
    if (field) add(field->negative);
  }
  return all;
}

std::vector<RegisterWrite> writes_of(const DeviceProfile& profile) {
  std::vector<RegisterWrite> all = profile.move;
  for (const StartStep& step : profile.start) all.push_back(step.write);
  if (profile.stop) all.push_back(*profile.stop);
  return all;
}

/// Texts of a profile stand in sentences and go to terminals.
Flaw flaw_of_texts(const DeviceProfile& profile) {
  std::vector<std::string> texts{profile.name};
  for (const RegisterCondition& one : conditions_of(profile)) texts.push_back(one.means);
  for (const StartStep& step : profile.start) texts.push_back(step.means);
  for (const std::string& text : texts) {
    if (harmless_line(text) == text) continue;
    return printable(profile.name) + " has characters in the text \"" + printable(text) +
           "\" that a terminal would obey";
  }
  return std::nullopt;
}

Flaw flaw_of_conditions(const DeviceProfile& profile) {
  for (const RegisterCondition& one : conditions_of(profile)) {
    if ((one.value & ~one.mask) == 0) continue;
    return profile.name + "'s condition on register " + std::to_string(one.address) +
           " can never hold: its value " + std::to_string(one.value) + " is not within its mask " +
           std::to_string(one.mask);
  }
  return std::nullopt;
}

bool fits(const WriteValue& value, WordOrder order) {
  if (value.source != ValueSource::Constant) return true;
  if (value.kind == WordKind::F32) return std::isfinite(static_cast<float>(value.number));
  return from_words(to_words(value.number, value.kind, order), value.kind, order) ==
         std::round(value.number);
}

Flaw flaw_of_writes(const DeviceProfile& profile) {
  for (const RegisterWrite& write : writes_of(profile)) {
    for (const WriteValue& value : write.values) {
      if (fits(value, profile.order)) continue;
      return profile.name + " writes a number to register " + std::to_string(write.address) +
             " that its kind cannot hold: " + std::to_string(value.number);
    }
  }
  return std::nullopt;
}

/// What moves must know where to, and be told to stand still.
Flaw flaw_of_motion(const DeviceProfile& profile) {
  if (profile.move.empty()) return std::nullopt;
  if (!profile.position) return profile.name + " moves, and has no position";
  if (profile.exchange && profile.move.size() != 1) {
    return profile.name + " exchanges: its move is one request";
  }
  const auto to_target = [](const RegisterWrite& write) {
    return std::ranges::any_of(write.values, [](const WriteValue& value) {
      return value.source == ValueSource::Position;
    });
  };
  if (std::ranges::none_of(profile.move, to_target)) {
    return profile.name + "'s move writes no target (source: \"target\")";
  }
  if (!profile.stop) return profile.name + " moves, and has no stop";
  return std::nullopt;
}

Flaw flaw_of_reading(const DeviceProfile& profile) {
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
  return std::nullopt;
}

}  // namespace

std::optional<std::string> flaw_of(const DeviceProfile& profile,
                                   const DeviceInstallation& installation) {
  for (const auto& flaw_in : {flaw_of_texts,  // first: later sentences name it
                              flaw_of_reading,
                              flaw_of_conditions,
                              flaw_of_writes,
                              flaw_of_motion}) {
    if (auto flaw = flaw_in(profile)) return flaw;
  }
  if (profile.silence <= profile.period) {
    return profile.name + "'s silence is not longer than its period: it would never live";
  }
  if (installation.travel_min >= installation.travel_max) return profile.name + " has no travel";
  return std::nullopt;
}

}  // namespace palp::patient
