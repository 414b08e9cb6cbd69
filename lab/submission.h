#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "common/core/result.h"

namespace palp::lab {

/// A run of many cases that other people's schedulers spread over machines: a folder with a script
/// for a shard and one for the merge, and the line that starts them. Every shard writes a file of
/// its own, whole or not at all, and is left out where that file is there: started again, only what
/// is missing runs.
struct Submission {
  std::string engine;  ///< slurm, ssh or print
  std::string folder;
  std::string hosts;  ///< of ssh: a file for GNU parallel's --sshloginfile; empty: here
  std::uint64_t shards{8};
  std::string from;                  ///< the folder that relative names are meant from
  std::vector<std::string> command;  ///< program, verb and flags of the whole
};

/// The flags of a batch verb.
void declare_submission(config::CommandLine& verb, Submission& submission);

/// `words` of the command line without what only the engine or the merge need: --submit, --shards,
/// --folder, --hosts, --shard, --cores, --report, --cases, --svg, --metric.
[[nodiscard]] std::vector<std::string> command_of_shard(const std::vector<std::string>& words);
/// --report, --cases, --svg and --metric of `words`, with their values.
[[nodiscard]] std::vector<std::string> outputs_of(const std::vector<std::string>& words);

/// The script of one shard, whose number is its argument or Slurm's.
[[nodiscard]] std::string shard_script(const Submission& submission);
[[nodiscard]] std::string merge_script(const Submission& submission);
/// What starts all.
[[nodiscard]] std::string start_script(const Submission& submission);

/// Writes the three. @returns the path of what starts all.
[[nodiscard]] Result<std::string> write_submission(const Submission& submission);

/// The verb `progress`: how many shards of a folder are done, and which are missing. Missed while
/// any is.
class ProgressCommand {
 public:
  explicit ProgressCommand(config::CommandLine& line);
  [[nodiscard]] config::ExitStatus run() const;

 private:
  std::string folder_;
};

}  // namespace palp::lab
