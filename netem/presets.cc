#include "netem/presets.h"

#include <algorithm>
#include <optional>

#include "common/core/check.h"
#include "netem/profile_texts.h"

namespace palp::netem {
namespace {

void append(std::string& text, std::string_view more) {
  text += (text.empty() ? "" : " ") + std::string{more};
}

/// One `key: value` line. @returns the error, if it is one.
std::optional<std::string> read_line(std::string_view line, Preset& preset, bool& up, bool& down) {
  const std::size_t colon = line.find(": ");
  const std::string_view key = line.substr(0, colon);
  const std::string_view value =
      colon == std::string_view::npos ? std::string_view{} : line.substr(colon + 2);
  if (key == "summary") {
    append(preset.summary, value);
  } else if (key == "source") {
    append(preset.source, value);
  } else if (key == "up" || key == "down" || key == "both") {
    auto impairment = parse_impairment(value);
    if (!impairment) return impairment.error().text;
    up = up || key != "down";
    down = down || key != "up";
    if (key != "up") preset.down = *impairment;
    if (key != "down") preset.up = *std::move(impairment);
  } else {
    return "found '" + std::string{key} + "', expected summary, source, up, down or both";
  }
  return std::nullopt;
}

}  // namespace

Result<Preset> parse_preset(std::string_view name, std::string_view text) {
  Preset preset;
  preset.name = name;
  bool up = false;
  bool down = false;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (line.empty() || line.front() == '#') continue;
    if (const auto error = read_line(line, preset, up, down)) {
      return fail("preset " + preset.name + ", line " + std::to_string(number) + ": " + *error);
    }
  }
  if (!up || !down || preset.summary.empty() || preset.source.empty()) {
    return fail("preset " + preset.name + ": expected summary, source and both directions");
  }
  return preset;
}

const std::vector<Preset>& presets() {
  static const std::vector<Preset> kPresets = [] {
    std::vector<Preset> all;
    for (const ProfileText& profile : profile_texts()) {
      auto preset = parse_preset(profile.name, profile.text);
      PALP_CHECK(preset.has_value(), "the profiles built into the program are sound");
      all.push_back(*std::move(preset));
    }
    std::stable_sort(all.begin(), all.end(), [](const Preset& left, const Preset& right) {
      return left.up.delay.mean < right.up.delay.mean;
    });
    return all;
  }();
  return kPresets;
}

Result<Preset> find_preset(std::string_view name) {
  std::string names;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    names += (names.empty() ? "" : ", ") + preset.name;
  }
  return fail("preset '" + std::string{name} + "' is unknown, expected one of " + names);
}

}  // namespace palp::netem
