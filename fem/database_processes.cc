#include "fem/database_processes.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "fem/database_builder.h"

namespace palp::fem {
namespace {

constexpr int kSaveEvery = 4;  // cells
constexpr int kStartsMax = 3;  // of one process
constexpr int kRefused = 1;    // exit codes of such a process
constexpr int kStopped = 2;

auto place(const GridCell& cell) { return std::tuple{cell.shape, cell.depth, cell.radius}; }

/// For a person: how far, how fast, how long still.
class ShownProgress {
 public:
  ShownProgress(std::size_t before, std::size_t count, const std::function<double()>& wall)
      : wall_{wall}, before_{before}, count_{count}, began_{wall()} {}

  void show(std::size_t done) const {
    std::fprintf(stderr, "\rpalp-fem: %3zu %% of the grid", 100 * done / count_);
    const double each = (wall_() - began_) / static_cast<double>(done - before_);
    std::fprintf(stderr,
                 ", %.1f places a minute, %.0f s left\x1b[K",
                 60 / std::max(each, 1e-6),
                 each * static_cast<double>(count_ - done));
  }

 private:
  const std::function<double()>& wall_;
  std::size_t before_;  ///< places that were there
  std::size_t count_;
  double began_;  ///< [s]
};

/// One process: the cells of its share that `table` lacks. `wall`: null shows no progress.
Result<void> solve_share(DepthTable table,
                         const Shard& shard,
                         const std::string& path,
                         Accuracy mesh,
                         const std::function<double()>* wall) {
  std::set<std::tuple<InclusionShape, std::uint32_t, std::uint32_t>> have;
  for (const DepthMember& member : table.members) {
    have.insert({member.shape, member.depth, member.radius});
  }
  std::vector<GridCell> mine;
  const std::vector<GridCell> cells = cells_of(table.grid);
  for (std::size_t i = shard.index; i < cells.size(); i += shard.count) mine.push_back(cells[i]);
  const auto missing = std::stable_partition(
      mine.begin(), mine.end(), [&](const auto& cell) { return have.contains(place(cell)); });
  const auto first = static_cast<std::size_t>(missing - mine.begin());
  std::optional<ShownProgress> shown;
  if (wall != nullptr) shown.emplace(first, mine.size(), *wall);
  int unsaved = 0;
  for (std::size_t i = first; i < mine.size(); ++i) {
    for (DepthMember& member : solve_cell(table.grid, mine[i], mesh)) {
      table.members.push_back(std::move(member));
    }
    if (shown) shown->show(i + 1);
    if (++unsaved < kSaveEvery && i + 1 < mine.size()) continue;
    unsaved = 0;
    const auto written = config::write_whole_file(path, table_bytes(table));
    if (!written) return tl::unexpected<Error>(written.error());
  }
  if (shown) std::fputs("\n", stderr);
  return {};
}

/// One share of the work, and the process that does it.
struct Share {
  Shard cells;
  std::string part;
  Accuracy mesh{};
  const std::function<double()>* wall{};  ///< of the one that shows progress
  pid_t process{};
  int starts{};
};

/// Goes on from what its part file holds. Ends when its parent does, however that ends.
[[noreturn]] void work_on(DepthTable table, const Share& share, pid_t parent) {
  if (::prctl(PR_SET_PDEATHSIG, SIGTERM) != 0 || ::getppid() != parent) std::_Exit(kStopped);
  if (::access(share.part.c_str(), F_OK) == 0) {
    if (const auto part = load_table(share.part); part) {
      static_cast<void>(merge_table(table, *part));
    }
  }
  const auto done = solve_share(std::move(table), share.cells, share.part, share.mesh, share.wall);
  if (!done) std::fprintf(stderr, "palp-fem: %s\n", done.error().text.c_str());
  std::_Exit(done ? 0 : kRefused);
}

Result<void> start(const DepthTable& table, Share& share) {
  ++share.starts;
  const pid_t parent = ::getpid();
  share.process = ::fork();
  if (share.process < 0) return fail("cannot start a process for each core");
  if (share.process == 0) work_on(table, share, parent);
  return {};
}

std::string exit_status_of(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return "was ended by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
  }
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Result<DepthTable> load_table(const std::string& path) {
  const auto bytes = read_whole_file(path);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  auto table = parse_table(*bytes);
  if (!table) return fail(path + ": " + table.error().text);
  return table;
}

std::string part_name(const std::string& out, std::size_t core) {
  return out + ".part" + std::to_string(core);
}

Result<void> solve_on_all_cores(const DepthTable& table,
                                const Shard& shard,
                                const SolvingPlan& plan) {
  std::vector<Share> shares;
  for (std::size_t core = 0; core < plan.cores; ++core) {
    shares.push_back({.cells = {shard.index + shard.count * core, shard.count * plan.cores},
                      .part = part_name(plan.out, core),
                      .mesh = plan.mesh,
                      .wall = core == 0 && plan.wall ? &plan.wall : nullptr});
    if (auto started = start(table, shares.back()); !started) return started;
  }
  std::string failed;
  for (std::size_t running = shares.size(); running > 0;) {
    int status = 0;
    const pid_t ended = ::waitpid(-1, &status, 0);
    if (ended < 0) return fail("lost sight of the processes; start again to go on");
    const auto share = std::find_if(
        shares.begin(), shares.end(), [&](const Share& one) { return one.process == ended; });
    if (share == shares.end()) continue;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
      --running;
      continue;
    }
    const std::string sentence = "process " + std::to_string(share - shares.begin() + 1) + " of " +
                                 std::to_string(shares.size()) + " " + exit_status_of(status);
    const bool refused = WIFEXITED(status) && WEXITSTATUS(status) == kRefused;
    if (!refused && share->starts < kStartsMax) {
      std::fprintf(stderr, "\npalp-fem: %s; it is started again\n", sentence.c_str());
      if (auto started = start(table, *share); !started) return started;
      continue;
    }
    failed = sentence;
    --running;
  }
  if (!failed.empty()) {
    return fail(failed + "; what its part files hold is kept, start again to go on");
  }
  return {};
}

}  // namespace palp::fem
