#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "common/core/result.h"

namespace palp::config {

/// How the verbs of a program are cut into shards and put together again by its verb `merge`.
struct ShardForm {
  std::string program{};
  std::string part_flag{};              ///< names the file of a shard
  std::string part_ending{};            ///< of that file's name
  std::string resume{};                 ///< what makes a shard go on; empty: it does so by itself
  std::uint64_t first{};                ///< number of the first shard: 0 or 1
  std::vector<std::string> of_merge{};  ///< flags with a value that no shard gets
  std::vector<std::string> switches{};  ///< the same without a value
  std::vector<std::string> of_both{};   ///< flags with a value that the merge gets as well
};

/// A run of many cases that other people's schedulers spread over machines: a folder with a script
/// for a shard and one for the merge, and the line that starts them. Every shard writes a file of
/// its own, whole or not at all, and is left out where that file is there: started again, only what
/// is missing runs.
struct Submission {
  ShardForm form;
  std::string engine{};  ///< slurm, ssh or print; empty: it is run here
  std::string folder{};
  std::string hosts{};  ///< of ssh: a file for GNU parallel's --sshloginfile; empty: here
  std::uint64_t shards{8};
  std::string from{};                  ///< the folder that relative names are meant from
  std::vector<std::string> command{};  ///< program, verb and flags of the whole
};

/// The flags of a batch verb.
void declare_submission(CommandLine& verb, Submission& submission);

/// The command without what only the engine or the merge need.
[[nodiscard]] std::vector<std::string> command_of_shard(const Submission& submission);
/// What the merge needs of it: flags and values.
[[nodiscard]] std::vector<std::string> outputs_of(const Submission& submission);

/// The script of one shard, whose number from 0 is its argument or Slurm's.
[[nodiscard]] std::string shard_script(const Submission& submission);
[[nodiscard]] std::string merge_script(const Submission& submission);
/// What starts all. Over ssh it ends as the worst of the shards did, else as the merge.
[[nodiscard]] std::string start_script(const Submission& submission);

/// Writes the three. A folder of another submission is refused. @returns the path of what starts
/// all.
[[nodiscard]] Result<std::string> write_submission(const Submission& submission);

/// Writes the scripts for main()'s arguments and becomes what starts them, or prints its lines.
[[nodiscard]] ExitStatus submit(Submission submission, int argc, const char* const* argv);

/// The verb `progress`: how many shards of a folder are done, and which are missing. Missed while
/// any is.
class ProgressCommand {
 public:
  explicit ProgressCommand(CommandLine& line);
  [[nodiscard]] ExitStatus run() const;

 private:
  std::string folder_;
};

}  // namespace palp::config
