#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "common/config/submission.h"
#include "fem/curve_command.h"

namespace palp::fem {

/// `palp-fem database`, `merge`, `info`, as given.
struct DatabaseFlags {
  std::string out{"depth_database.bin"};
  std::string shard{};  ///< "i/n"; empty: all of it
  std::uint64_t cores{2};
  CurveFlags block{};  ///< what curve knows of block, tip and inclusion's material
  std::string grid{};  ///< file with axes of its own; empty: the default's, as far as they fit
  std::string accuracy{"normal"};
  bool off_axis{};        ///< solves the shape beside the axis as well, once the grid is whole
  std::uint64_t check{};  ///< phantoms between the grid's points, solved after the grid is whole
  std::string report{};
  std::vector<std::string> files{};  ///< of merge
  std::string file{};                ///< of info
  config::Submission submission{.form = {.program = "palp-fem",
                                         .part_flag = "--out",
                                         .part_ending = ".bin",
                                         .first = 1,
                                         .of_merge = {"--out", "--report", "--check"},
                                         .switches = {"--off-axis"},
                                         .of_both = {"--accuracy"}}};  ///< of database
  /// [s] since some instant; empty: nobody watches. main() knows clocks and terminals.
  std::function<double()> wall{};
  /// Work on so many threads, as io::for_each_index() does.
  std::function<void(std::size_t, std::size_t, const std::function<void(std::size_t)>&)>
      for_each_index{};
};

void declare_database(config::CommandLine& line, DatabaseFlags& flags);
void declare_merge(config::CommandLine& line, DatabaseFlags& flags);
void declare_info(config::CommandLine& line, DatabaseFlags& flags);

/// Solves what the file does not hold yet, on all cores (a process each), with progress for who
/// watches; interrupted and started again it goes on where it was.
[[nodiscard]] config::ExitStatus run_database(const DatabaseFlags& flags);
/// Missed while a part of the grid is missing.
[[nodiscard]] config::ExitStatus run_merge(const DatabaseFlags& flags);
[[nodiscard]] config::ExitStatus run_info(const DatabaseFlags& flags);

}  // namespace palp::fem
