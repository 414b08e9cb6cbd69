#pragma once

#include <cstdint>
#include <string>

#include "common/config/command_line.h"
#include "site_program/exit_status.h"

namespace palp::site_program {

/// The verb `certificates`: makes, renews and revokes what sites prove themselves with.
class CertificatesCommand {
 public:
  /// Declares the verb; this object outlives the line's parse().
  explicit CertificatesCommand(config::CommandLine& line);
  /// After the line was parsed with this verb. Prints what was made.
  [[nodiscard]] ExitStatus run() const;

 private:
  std::string folder_;
  std::string revoked_;
  std::string name_{"palp"};
  std::uint64_t days_{365};
  bool bench_{};
};

}  // namespace palp::site_program
