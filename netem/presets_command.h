#pragma once

#include <string>

#include "common/config/command_line.h"

namespace palp::netem {

/// The verb `presets` of palp-netem: the named links and where their numbers come from.
class PresetsCommand {
 public:
  /// Declares the verb; this object outlives the line's parse().
  explicit PresetsCommand(config::CommandLine& line);
  /// After the line was parsed with this verb. Text for people, or JSON of schema palp.presets/1.
  [[nodiscard]] config::ExitStatus run() const;

 private:
  std::string name_;  ///< empty: all
  bool json_{};
};

}  // namespace palp::netem
