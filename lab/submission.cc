#include "lab/submission.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "common/config/flag_value.h"
#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/whole_file.h"

namespace palp::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kOfEngine{
    "--submit", "--shards", "--folder", "--hosts", "--shard", "--cores"};
constexpr std::array<std::string_view, 4> kOfMerge{"--report", "--cases", "--svg", "--metric"};
constexpr char kCountFile[] = "shards";

/// One word of a shell, whatever is in it.
std::string quoted_word(const std::string& word) {
  std::string text = "'";
  for (const char one : word) text += one == '\'' ? std::string{"'\\''"} : std::string{one};
  return text + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quoted_word(word);
  return line;
}

template <std::size_t kCount>
bool names_flag(const std::array<std::string_view, kCount>& flags, std::string_view word) {
  return std::ranges::any_of(flags, [word](std::string_view flag) {
    return word == flag || (word.starts_with(flag) && word[flag.size()] == '=');
  });
}

/// The words that are, or are not, one of the flags and its value.
template <std::size_t kCount>
std::vector<std::string> words_of(const std::vector<std::string>& words,
                                  const std::array<std::string_view, kCount>& flags,
                                  bool wanted) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool named = names_flag(flags, words[i]);
    const bool apart = named && words[i].find('=') == std::string::npos && i + 1 < words.size();
    if (named == wanted) found.push_back(words[i]);
    if (apart && wanted) found.push_back(words[i + 1]);
    if (apart) ++i;
  }
  return found;
}

std::string part_file(std::uint64_t number) { return "part-" + std::to_string(number) + ".csv"; }

}  // namespace

void declare_submission(config::CommandLine& verb, Submission& submission) {
  verb.choice("--submit",
              submission.engine,
              {"slurm", "ssh", "print"},
              "spread over machines by Slurm, by GNU parallel over ssh; or print the lines");
  verb.text("--folder", submission.folder, "FOLDER", "of a submission, seen by all machines");
  verb.whole("--shards", submission.shards, {.min = 1, .max = 10'000}, "of a submission");
  verb.text(
      "--hosts", submission.hosts, "FILE", "of ssh, as parallel's --sshloginfile; none: here");
}

std::vector<std::string> command_of_shard(const std::vector<std::string>& words) {
  return words_of(words_of(words, kOfEngine, false), kOfMerge, false);
}

std::vector<std::string> outputs_of(const std::vector<std::string>& words) {
  return words_of(words, kOfMerge, true);
}

std::string shard_script(const Submission& submission) {
  const std::string count = std::to_string(submission.shards);
  return "#!/bin/sh\n"
         "# One shard of " +
         count +
         ": its number is the argument, or Slurm's. What is there already is kept.\n"
         "#SBATCH --requeue --cpus-per-task=1 --output=" +
         submission.folder + "/shard-%a.log\n" + "cd " + quoted_word(submission.from) +
         " || exit 3\n"
         "shard=${1:-$SLURM_ARRAY_TASK_ID}\n"
         "part=" +
         quoted_word(submission.folder) +
         "/part-$shard.csv\n"
         "[ -s \"$part\" ] && exit 0\n"
         "exec " +
         shell_line(command_of_shard(submission.command)) + " --shard \"$shard/" + count +
         "\" --cases \"$part\" --cores 1\n";
}

std::string merge_script(const Submission& submission) {
  std::vector<std::string> words{submission.command.front(), "merge"};
  for (std::uint64_t i = 0; i < submission.shards; ++i) {
    words.push_back(submission.folder + "/" + part_file(i));
  }
  for (const std::string& word : outputs_of(submission.command)) words.push_back(word);
  return "#!/bin/sh\n#SBATCH --output=" + submission.folder + "/merge.log\ncd " +
         quoted_word(submission.from) + " || exit 3\nexec " + shell_line(words) + "\n";
}

std::string start_script(const Submission& submission) {
  const std::string folder = quoted_word(submission.folder);
  const std::string last = std::to_string(submission.shards - 1);
  if (submission.engine == "slurm") {
    return "#!/bin/sh\n"
           "job=$(sbatch --parsable --array=0-" +
           last + " " + folder +
           "/shard.sh) || exit 3\n"
           "sbatch --parsable --dependency=afterok:\"${job%%;*}\" " +
           folder + "/merge.sh\n";
  }
  const std::string hosts =
      submission.hosts.empty() ? "" : "--sshloginfile " + quoted_word(submission.hosts) + " ";
  return "#!/bin/sh\nparallel " + hosts + "sh " + folder + "/shard.sh {} ::: $(seq 0 " + last +
         ") && sh " + folder + "/merge.sh\n";
}

Result<std::string> write_submission(const Submission& submission) {
  if (submission.folder.empty()) return fail("--submit needs --folder");
  Submission whole = submission;
  std::error_code refused;
  fs::create_directories(submission.folder, refused);
  if (refused) return fail_to_reach("--folder: cannot be made: " + refused.message());
  whole.folder = fs::absolute(submission.folder, refused).lexically_normal().string();
  whole.from = fs::current_path(refused).string();
  const std::string start = whole.folder + "/start.sh";
  for (const auto& [file, text] :
       {std::pair{whole.folder + "/shard.sh", shard_script(whole)},
        std::pair{whole.folder + "/merge.sh", merge_script(whole)},
        std::pair{whole.folder + "/" + kCountFile, std::to_string(whole.shards) + "\n"},
        std::pair{start, start_script(whole)}}) {
    if (const auto written = config::write_whole_file(file, text); !written) {
      return fail_to_reach(written.error().text);
    }
  }
  return start;
}

ProgressCommand::ProgressCommand(config::CommandLine& line) {
  config::CommandLine& verb = line.verb("progress", "how far a submission is");
  verb.argument("FOLDER", folder_, "as --folder said");
  verb.required();
}

config::ExitStatus ProgressCommand::run() const {
  const auto text = read_whole_file(folder_ + "/" + kCountFile);
  if (!text) return config::refusal("palp-lab", {folder_ + " holds no submission", true});
  const std::string digits = text->substr(0, text->find('\n'));
  const auto count = config::read_whole(kCountFile, digits, {.min = 1, .max = 10'000});
  if (!count) return config::refusal("palp-lab", count.error());
  std::string missing;
  std::uint64_t done = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    std::error_code ignored;
    const std::uintmax_t size = fs::file_size(folder_ + "/" + part_file(i), ignored);
    if (!ignored && size > 0) {
      ++done;
    } else {
      missing += (missing.empty() ? "" : ", ") + std::to_string(i);
    }
  }
  const std::string line = std::to_string(done) + " of " + std::to_string(*count) + " shards";
  if (missing.empty()) return {config::ExitCode::Done, line};
  return {config::ExitCode::Missed, "palp-lab: " + line + "; missing: " + missing};
}

}  // namespace palp::lab
