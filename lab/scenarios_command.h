#pragma once

#include "common/config/command_line.h"

namespace palp::lab {

/// The verb `scenarios` of palp-lab: the scenarios and sets that may be asked for by name.
class ScenariosCommand {
 public:
  /// Declares the verb; this object outlives the line's parse().
  explicit ScenariosCommand(config::CommandLine& line);
  /// After the line was parsed with this verb. Text for people, or JSON of schema palp.scenarios/1.
  [[nodiscard]] config::ExitStatus run() const;

 private:
  bool json_{};
};

}  // namespace palp::lab
