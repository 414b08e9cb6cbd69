#include "common/config/settings_flags.h"

#include "common/config/settings_text.h"
#include "common/core/whole_file.h"

namespace palp::config {
namespace {

std::optional<ExitStatus> as_exit_status(const Result<void>& result) {
  return result ? std::nullopt : std::optional{ExitStatus{ExitCode::BadInput, result.error().text}};
}

}  // namespace

std::optional<ExitStatus> SettingsFlags::fill() const {
  if (document == nullptr) {
    return std::nullopt;
  }
  if (!config_file.empty()) {
    const auto text = read_whole_file(config_file);
    if (!text) {
      return ExitStatus{ExitCode::CannotOpen, "--config: " + text.error().text};
    }
    if (auto exit_status = as_exit_status(document->merge(*text, config_file))) {
      return exit_status;
    }
  }
  for (const std::string& assignment : overrides) {
    if (auto exit_status = as_exit_status(document->set(assignment))) {
      exit_status->text = "--set " + exit_status->text;
      return exit_status;
    }
  }
  for (const auto& [path, value, flag] : knobs) {
    if (auto exit_status = as_exit_status(document->set(path, value, flag))) {
      return exit_status;
    }
  }
  return as_exit_status(document->check());
}

}  // namespace palp::config
