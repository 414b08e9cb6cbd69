#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/config/command_line.h"
#include "common/config/submission.h"
#include "common/plot/picture.h"
#include "lab/plan/batch.h"

/// The verbs of palp-lab that run many cases.
namespace palp::lab {

/// What the process has to offer: main() knows processors and clocks, the lab does not.
struct Machine {
  std::size_t processors{1};
  std::function<void(
      std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& work)>
      for_each_index;
  std::function<std::pair<double, double>()> used;  ///< [s] of processor time, [s] of wall time
  bool watched{};                                   ///< somebody sees standard error
  std::string made_by{};                            ///< program and processor
};

/// What ends this program, said in one sentence.
[[nodiscard]] inline config::ExitStatus refusal(const Error& fault) {
  return config::refusal("palp-lab", fault);
}

/// One line that is written over, for a person: how far, how fast, how long still. Null where
/// nobody watches; `machine` outlives it.
[[nodiscard]] Progress shown_progress(const Machine& machine);
/// For a person: bits agree only where libraries and processors do.
void warn_of_makers(const std::vector<std::string>& makers);

inline constexpr std::size_t kCasesSizeMax = std::size_t{1} << 30;  // [bytes], two million rows

/// Of all verbs that are spread over machines.
[[nodiscard]] config::ShardForm shard_form();

struct BatchArguments {
  std::string set;  ///< empty: mc; of a merge: whatever its cases are
  std::string scenario{"standard"};
  std::string coupling;
  std::string tissue;
  std::string shard;
  std::string report;
  std::string cases;
  std::string csv;  ///< of a merge of depths
  plot::PictureFlags picture;
  std::string metric{"tap_a_error"};
  std::vector<std::string> list;  ///< axes of a sweep, files of a merge
  std::optional<std::uint64_t> seed;
  std::uint64_t count{1000};
  std::uint64_t repeats{1};
  std::optional<std::uint64_t> cores{};  ///< nothing: all
  bool resume{};                         ///< takes only what an interrupted batch has not
  bool keeps_rows{true};                 ///< as they come, beside `cases`
  config::Submission submission{.form = shard_form()};  ///< of montecarlo, adversary, map, sweep
};

/// Declares the verbs; `arguments` outlives the command line.
void declare_batch_verbs(config::CommandLine& line, BatchArguments& arguments);
/// Runs the one chosen; nullopt: it is none of them.
[[nodiscard]] std::optional<config::ExitStatus> run_batch_verb(const std::string& verb,
                                                               const BatchArguments& arguments,
                                                               const Machine& machine);

}  // namespace palp::lab
