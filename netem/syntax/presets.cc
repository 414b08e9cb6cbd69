#include "netem/syntax/presets.h"

#include <algorithm>

#include "netem/syntax/profile_texts.h"

namespace palp::netem {

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const ProfileText& profile : profile_texts()) names.emplace_back(profile.name);
  return names;
}

std::string_view preset_text(std::string_view name) {
  for (const ProfileText& profile : profile_texts()) {
    if (profile.name == name) return profile.text;
  }
  return {};
}

Result<Timeline> find_preset(std::string_view name) {
  const std::string_view text = preset_text(name);
  if (text.empty()) {
    std::string names;
    for (const std::string& known : preset_names()) names += (names.empty() ? "" : ", ") + known;
    return fail("preset '" + std::string{name} + "' is unknown, expected one of " + names);
  }
  const auto no_other = [](const std::string&) -> Result<Timeline> {
    return fail("a preset stands on no other");
  };
  auto timeline = parse_timeline("preset " + std::string{name}, text, no_other);
  if (timeline) timeline->preset = name;
  return timeline;
}

}  // namespace palp::netem
