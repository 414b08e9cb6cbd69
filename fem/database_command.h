#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/command_line.h"

namespace palp::fem {

/// `palp-fem database`, `merge`, `info`, as given.
struct DatabaseFlags {
  std::string out{"depth_database.bin"};
  std::string shard{};  ///< "i/n"; empty: all of it
  std::uint64_t cores{2};
  std::uint64_t check{};  ///< phantoms between the grid's points, solved after the grid is whole
  std::string report{};
  std::vector<std::string> files{};  ///< of merge
  std::string file{};                ///< of info
};

void declare_database(config::CommandLine& line, DatabaseFlags& flags);
void declare_merge(config::CommandLine& line, DatabaseFlags& flags);
void declare_info(config::CommandLine& line, DatabaseFlags& flags);

/// Solves what the file does not hold yet, on all cores (a process each), with progress on standard
/// error; interrupted and started again it goes on where it was.
[[nodiscard]] config::ExitStatus run_database(const DatabaseFlags& flags);
[[nodiscard]] config::ExitStatus run_merge(const DatabaseFlags& flags);
[[nodiscard]] config::ExitStatus run_info(const DatabaseFlags& flags);

}  // namespace palp::fem
