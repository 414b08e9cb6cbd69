#pragma once

#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "common/io/net/machine_check.h"
#include "common/io/secure/credentials.h"
#include "common/link/telegram.h"
#include "site_program/exit_status.h"

namespace palp::site_program {

/// The verb `check`: can this machine run a site on time, and what should be changed?
class CheckCommand {
 public:
  /// Declares the verb; this object outlives the line's parse(). Only a surgeon can look at the way
  /// to its peer: the patient is called. Both can look at their identity.
  CheckCommand(config::CommandLine& line, link::Role role);
  /// After the line was parsed with this verb: an idle loop with the default settings of a site's.
  /// Prints a line for each thing looked at. Missed where something should be changed.
  [[nodiscard]] ExitStatus run() const;

 private:
  [[nodiscard]] Result<std::vector<io::MachineFinding>> beyond_the_machine() const;

  link::Role role_;
  double seconds_{5};  ///< [s]
  std::string peer_;
  std::string relay_;
  std::string identity_;
  std::string report_;
};

/// Whether what a site proves itself with is in order.
[[nodiscard]] io::MachineFinding judge_identity(const io::Credentials& credentials);
/// "good  timer lateness  99 % of ...", and the advice below what is not.
[[nodiscard]] std::string check_text(const std::vector<io::MachineFinding>& findings);
/// Schema palp.check/1.
[[nodiscard]] std::string check_json(const std::vector<io::MachineFinding>& findings);

}  // namespace palp::site_program
