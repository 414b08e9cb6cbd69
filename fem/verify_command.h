#pragma once

#include <string>

#include "common/config/command_line.h"
#include "fem/verification.h"

namespace palp::fem {

/// `palp-fem verify`, as given on the command line.
struct VerifyFlags {
  bool quick{};
  std::string report{};
};

void declare_verify(config::CommandLine& line, VerifyFlags& flags);
/// Prints the table; TargetMissed if a row fails.
[[nodiscard]] config::ExitStatus run_verify(const VerifyFlags& flags);

[[nodiscard]] std::string verify_table(const Checks& checks);
[[nodiscard]] std::string verify_report(const Checks& checks);

}  // namespace palp::fem
