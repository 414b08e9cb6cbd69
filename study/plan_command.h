#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/config/command_line.h"

namespace palp::study {

/// `palp-study plan`, as given on the command line.
struct PlanFlags {
  std::string file{};
  std::string folder{};
  std::optional<std::uint64_t> letters{};  ///< nothing: by chance
};

void declare_plan(config::CommandLine& line, PlanFlags& flags);
/// `made_by`: version and commit of this program; `entropy`: 64 bits that nobody can guess, from
/// which the letters are drawn.
[[nodiscard]] config::ExitStatus run_plan(const PlanFlags& flags,
                                          const std::string& made_by,
                                          const std::function<std::uint64_t()>& entropy);

}  // namespace palp::study
