#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "common/core/result.h"
#include "fem/depth_table.h"
#include "fem/mesh.h"

/// A depth database solved by a process for each core. What is solved is kept in files beside the
/// database, so that a run goes on after an interruption.
namespace palp::fem {

/// One of `count` equal shares of the grid's cells.
struct Shard {
  std::size_t index{};  ///< from 0
  std::size_t count{1};
};

struct SolvingPlan {
  std::string out;       ///< the database's file
  std::size_t cores{1};  ///< >= 1
  Accuracy mesh{};
  std::function<double()> wall{};  ///< [s]; null: no progress is shown
};

/// A table from its file; the sentence names the file.
[[nodiscard]] Result<DepthTable> load_table(const std::string& path);

/// Where the process of that core keeps what it solved.
[[nodiscard]] std::string part_name(const std::string& out, std::size_t core);

/// Solves the cells of the shard that `table` lacks, into part_name() of each core. Blocks. A
/// process that was ended from outside is started again, three times at most; one that refuses its
/// work is not.
[[nodiscard]] Result<void> solve_on_all_cores(const DepthTable& table,
                                              const Shard& shard,
                                              const SolvingPlan& plan);

}  // namespace palp::fem
