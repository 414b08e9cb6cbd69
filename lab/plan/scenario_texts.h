#pragma once

#include <span>
#include <string_view>

namespace palp::lab {

struct ScenarioText {
  std::string_view name;
  std::string_view text;
};

/// The files of lab/scenarios, built in so that the program runs from anywhere.
[[nodiscard]] std::span<const ScenarioText> scenario_texts() noexcept;

}  // namespace palp::lab
