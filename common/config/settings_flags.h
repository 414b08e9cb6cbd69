#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/config/document.h"
#include "common/config/exit_status.h"

namespace palp::config {

/// What a command line says of settings, until it is put into their document.
struct SettingsFlags {
  Document* document{};  ///< null: the program has no settings
  std::string config_file;
  std::vector<std::string> overrides;             ///< of --set
  std::vector<std::array<std::string, 3>> knobs;  ///< given: path, value, flag

  /// Knobs beat --set, which beats the file. @returns what was wrong.
  [[nodiscard]] std::optional<ExitStatus> fill() const;
};

}  // namespace palp::config
