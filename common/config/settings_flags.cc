#include "common/config/settings_flags.h"

#include "common/config/settings_text.h"

namespace palp::config {
namespace {

std::optional<Ending> as_ending(const Result<void>& result) {
  return result ? std::nullopt : std::optional{Ending{ExitCode::BadInput, result.error().text}};
}

}  // namespace

std::optional<Ending> SettingsFlags::fill() const {
  if (document == nullptr) {
    return std::nullopt;
  }
  if (!config_file.empty()) {
    const auto text = read_whole_file(config_file);
    if (!text) {
      return Ending{ExitCode::CannotOpen, "--config: " + text.error().text};
    }
    if (auto ending = as_ending(document->merge(*text, config_file))) {
      return ending;
    }
  }
  for (const std::string& assignment : overrides) {
    if (auto ending = as_ending(document->set(assignment))) {
      ending->text = "--set " + ending->text;
      return ending;
    }
  }
  for (const auto& [path, value, flag] : knobs) {
    if (auto ending = as_ending(document->set(path, value, flag))) {
      return ending;
    }
  }
  return as_ending(document->check());
}

}  // namespace palp::config
