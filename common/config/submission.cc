#include "common/config/submission.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include <unistd.h>

#include "common/config/flag_value.h"
#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/whole_file.h"

namespace palp::config {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kOfEngine{
    "--submit", "--shards", "--folder", "--hosts", "--shard", "--cores"};
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

bool names_flag(const std::vector<std::string>& flags, std::string_view word) {
  return std::ranges::any_of(flags, [word](std::string_view flag) {
    return word == flag || (word.starts_with(flag) && word[flag.size()] == '=');
  });
}

/// The words that are, or are not, one of the flags and its value.
std::vector<std::string> words_of(const std::vector<std::string>& words,
                                  const std::vector<std::string>& flags,
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

std::string part_file(std::uint64_t number, const std::string& ending) {
  return "part-" + std::to_string(number) + ending;
}

std::string starts_slurm(const std::string& folder, const std::string& last) {
  return "#!/bin/sh\n"
         "job=$(sbatch --parsable --array=0-" +
         last + " " + folder +
         "/shard.sh) || exit 3\n"
         "sbatch --parsable --dependency=afterok:\"${job%%;*}\" " +
         folder + "/merge.sh || exit 3\n";
}

/// GNU parallel tells how many shards failed; what is asked is how. What ssh itself ends with is
/// 255, and a shard that was killed has no exit code.
std::string starts_ssh(const Submission& submission,
                       const std::string& folder,
                       const std::string& last) {
  const std::string hosts =
      submission.hosts.empty() ? "" : "--sshloginfile " + quoted_word(submission.hosts) + " ";
  const std::string& program = submission.form.program;
  return "#!/bin/sh\n"
         "command -v parallel >/dev/null || {\n"
         "  echo '" +
         program +
         ": --submit ssh needs GNU parallel (apt-get install parallel)' >&2\n"
         "  exit 3\n"
         "}\n"
         "log=" +
         folder +
         "/jobs.log\n"
         "if parallel --joblog \"$log\" " +
         hosts + "sh " + folder + "/shard.sh {} ::: $(seq 0 " + last + "); then\n  exec sh " +
         folder +
         "/merge.sh\n"
         "fi\n"
         "echo '" +
         program + ": not all shards were made; palp-lab progress '" + folder +
         "' names those that are missing, the same command makes them' >&2\n"
         "[ -s \"$log\" ] || exit 3\n"
         "exit \"$(awk 'NR > 1 && $7 + 0 > most { most = $7 + 0 }\n"
         "  END { print (NR < 2 || most == 255 ? 3 : most >= 1 && most <= 4 ? most : 4) }' "
         "\"$log\")\"\n";
}

}  // namespace

void declare_submission(CommandLine& verb, Submission& submission) {
  verb.choice("--submit",
              submission.engine,
              {"slurm", "ssh", "print"},
              "spread over machines by Slurm, by GNU parallel over ssh; or print the lines");
  verb.text("--folder", submission.folder, "FOLDER", "of a submission, seen by all machines");
  verb.whole("--shards", submission.shards, {.min = 1, .max = 10'000}, "of a submission");
  verb.text(
      "--hosts", submission.hosts, "FILE", "of ssh, as parallel's --sshloginfile; none: here");
}

std::vector<std::string> command_of_shard(const Submission& submission) {
  auto words =
      words_of(words_of(submission.command, kOfEngine, false), submission.form.of_merge, false);
  std::erase(words, submission.form.resume);
  for (const std::string& one : submission.form.switches) std::erase(words, one);
  return words;
}

std::vector<std::string> outputs_of(const Submission& submission) {
  const ShardForm& form = submission.form;
  std::vector<std::string> flags = form.of_merge;
  flags.insert(flags.end(), form.of_both.begin(), form.of_both.end());
  std::vector<std::string> words = words_of(submission.command, flags, true);
  std::ranges::copy_if(form.switches, std::back_inserter(words), [&](const std::string& one) {
    return std::ranges::find(submission.command, one) != submission.command.end();
  });
  return words;
}

std::string shard_script(const Submission& submission) {
  const std::string count = std::to_string(submission.shards);
  const ShardForm& form = submission.form;
  const std::string number =
      form.first == 0 ? "$shard" : "$((shard + " + std::to_string(form.first) + "))";
  return "#!/bin/sh\n"
         "# One shard of " +
         count +
         ": its number is the argument, or Slurm's. What is there already is kept.\n"
         "#SBATCH --requeue --cpus-per-task=1 --output=" +
         submission.folder + "/shard-%a.log\n" + "cd " + quoted_word(submission.from) +
         " || exit 3\n"
         "shard=${1:-$SLURM_ARRAY_TASK_ID}\n"
         "part=" +
         quoted_word(submission.folder) + "/part-$shard" + form.part_ending +
         "\n"
         "[ -s \"$part\" ] && exit 0\n"
         "exec " +
         shell_line(command_of_shard(submission)) + " --shard \"" + number + "/" + count + "\" " +
         form.part_flag + " \"$part\" --cores 1" + (form.resume.empty() ? "" : " " + form.resume) +
         "\n";
}

std::string merge_script(const Submission& submission) {
  std::vector<std::string> words{submission.command.front(), "merge"};
  for (std::uint64_t i = 0; i < submission.shards; ++i) {
    words.push_back(submission.folder + "/" + part_file(i, submission.form.part_ending));
  }
  for (const std::string& word : outputs_of(submission)) words.push_back(word);
  return "#!/bin/sh\n#SBATCH --output=" + submission.folder + "/merge.log\ncd " +
         quoted_word(submission.from) + " || exit 3\nexec " + shell_line(words) + "\n";
}

std::string start_script(const Submission& submission) {
  const std::string folder = quoted_word(submission.folder);
  const std::string last = std::to_string(submission.shards - 1);
  return submission.engine == "slurm" ? starts_slurm(folder, last)
                                      : starts_ssh(submission, folder, last);
}

Result<std::string> write_submission(const Submission& submission) {
  if (submission.folder.empty()) return fail("--submit needs --folder");
  Submission whole = submission;
  std::error_code refused;
  fs::create_directories(submission.folder, refused);
  if (refused) return fail_to_reach("--folder: cannot be made: " + refused.message());
  whole.folder = fs::absolute(submission.folder, refused).lexically_normal().string();
  whole.from = fs::current_path(refused).string();
  const std::string shard = whole.folder + "/shard.sh";
  // What another command left there would be taken for shards of this one.
  if (const auto before = read_whole_file(shard); before && *before != shard_script(whole)) {
    return fail("--folder: " + submission.folder +
                " holds the shards of another command; name another folder");
  }
  const std::string start = whole.folder + "/start.sh";
  for (const auto& [file, text] :
       {std::pair{shard, shard_script(whole)},
        std::pair{whole.folder + "/merge.sh", merge_script(whole)},
        std::pair{whole.folder + "/" + kCountFile,
                  std::to_string(whole.shards) + "\n" + whole.form.part_ending + "\n"},
        std::pair{start, start_script(whole)}}) {
    if (const auto written = write_whole_file(file, text); !written) {
      return fail_to_reach(written.error().text);
    }
  }
  return start;
}

ExitStatus submit(Submission submission, int argc, const char* const* argv) {
  const std::string& name = submission.form.program;
  std::error_code unknown;
  const auto program = fs::read_symlink("/proc/self/exe", unknown);
  submission.command.assign(argv, argv + argc);
  if (!unknown) submission.command.front() = program.string();
  const auto start = write_submission(submission);
  if (!start) return refusal(name, start.error());
  if (submission.engine == "print") {
    const auto lines = read_whole_file(*start);
    return lines ? ExitStatus{ExitCode::Done, *lines} : refusal(name, lines.error());
  }
  (void)::execl("/bin/sh", "sh", start->c_str(), static_cast<char*>(nullptr));
  return {ExitCode::CannotOpen, name + ": cannot start /bin/sh"};
}

ProgressCommand::ProgressCommand(CommandLine& line) {
  CommandLine& verb = line.verb("progress", "how far a submission is");
  verb.argument("FOLDER", folder_, "as --folder said");
  verb.required();
}

ExitStatus ProgressCommand::run() const {
  const auto text = read_whole_file(folder_ + "/" + kCountFile);
  if (!text) return refusal("palp-lab", {folder_ + " holds no submission", true});
  const std::size_t first_line = text->find('\n');
  const auto count = read_whole(kCountFile, text->substr(0, first_line), {.min = 1, .max = 10'000});
  if (!count) return refusal("palp-lab", count.error());
  std::string ending =
      first_line == std::string::npos ? std::string{} : text->substr(first_line + 1);
  ending.resize(std::min(ending.find('\n'), ending.size()));
  std::string missing;
  std::uint64_t done = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    std::error_code ignored;
    const std::uintmax_t size = fs::file_size(folder_ + "/" + part_file(i, ending), ignored);
    if (!ignored && size > 0) {
      ++done;
    } else {
      missing += (missing.empty() ? "" : ", ") + std::to_string(i);
    }
  }
  const std::string line = std::to_string(done) + " of " + std::to_string(*count) + " shards";
  if (missing.empty()) return {ExitCode::Done, line};
  return {ExitCode::Missed, "palp-lab: " + line + "; missing: " + missing};
}

}  // namespace palp::config
