#include "lab/depth_command.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <set>
#include <string_view>
#include <type_traits>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/conventions.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "lab/number_list.h"
#include "lab/partial_rows.h"
#include "lab/plan/plan.h"
#include "lab/report/depth_cases.h"
#include "lab/report/depth_picture.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

using config::ExitCode;
using config::ExitStatus;

constexpr std::uint32_t kWideShare = 5;  // so many random phantoms for a wide one

ExitStatus bad_input(const std::string& sentence) {
  return {ExitCode::BadInput, "palp-lab: " + sentence};
}

Result<DepthStudy> study_of(const DepthFlags& flags) {
  DepthStudy study{.depths = {},
                   .count = static_cast<std::uint32_t>(flags.count),
                   .repeats = static_cast<std::uint32_t>(flags.repeats),
                   .seed = flags.seed,
                   .estimator = flags.estimator == "paper" ? depth::EstimatorKind::Paper
                                                           : depth::EstimatorKind::Bayes,
                   .taps = static_cast<int>(flags.taps),
                   .reference_taps = static_cast<int>(flags.reference_taps),
                   .round_trip = flags.rtt_ms * 1e-3,
                   .loss = flags.loss,
                   .coupling = flags.coupling};
  study.wide_count = flags.wide ? study.count : study.count / kWideShare;
  if (flags.depths_mm.empty()) return study;
  const auto depths = parse_numbers("--depths-mm", flags.depths_mm, 3, 27);
  if (!depths) return tl::unexpected(depths.error());
  for (const double depth : *depths) study.depths.push_back(depth * kMillimetre);
  return study;
}

/// A process for each core: the ith of the cases belongs to process i modulo their number.
struct Worker {
  pid_t child{};
  int pipe{};         ///< -1: it has ended
  std::string bytes;  ///< of a case that has not come whole
};

bool write_all(int to, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t done = ::write(to, bytes, size);
    if (done <= 0) return false;
    bytes += done;
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

[[noreturn]] void work(const DepthStudy& study,
                       const std::vector<std::uint32_t>& indices,
                       std::size_t first,
                       std::size_t step,
                       int to) {
  for (std::size_t i = first; i < indices.size(); i += step) {
    const auto one = run_case(study, indices[i]);
    if (!one) {
      std::fprintf(stderr, "palp-lab: %s\n", one.error().text.c_str());
      std::_Exit(2);
    }
    static_assert(std::is_trivially_copyable_v<DepthCase>);
    if (!write_all(to, reinterpret_cast<const char*>(&*one), sizeof(DepthCase))) std::_Exit(3);
  }
  std::_Exit(0);
}

Result<std::vector<Worker>> start_workers(const DepthStudy& study,
                                          const std::vector<std::uint32_t>& indices,
                                          std::size_t cores) {
  std::vector<Worker> workers;
  for (std::size_t core = 0; core < cores; ++core) {
    int ends[2];
    if (::pipe(ends) != 0) return fail("cannot open a pipe to a process");
    const pid_t child = ::fork();
    if (child < 0) return fail("cannot start a process for each core");
    if (child == 0) work(study, indices, core, cores, ends[1]);
    ::close(ends[1]);
    workers.push_back({child, ends[0], {}});
  }
  return workers;
}

/// Calls `sink` with every case as it comes.
Result<void> run_on_cores(const DepthStudy& study,
                          const std::vector<std::uint32_t>& indices,
                          std::size_t cores,
                          const std::function<void(const DepthCase&)>& sink) {
  auto workers = start_workers(study, indices, cores);
  if (!workers) return tl::unexpected(workers.error());
  bool sound = true;
  for (std::size_t running = workers->size(); running > 0;) {
    std::vector<pollfd> ready;
    for (const Worker& worker : *workers) ready.push_back({worker.pipe, POLLIN, 0});
    if (::poll(ready.data(), ready.size(), -1) < 0) continue;  // a signal
    for (std::size_t i = 0; i < ready.size(); ++i) {
      Worker& worker = (*workers)[i];
      if (worker.pipe < 0 || ready[i].revents == 0) continue;
      char chunk[4096];
      const ssize_t got = ::read(worker.pipe, chunk, sizeof chunk);
      if (got > 0) {
        worker.bytes.append(chunk, static_cast<std::size_t>(got));
      } else {
        ::close(worker.pipe);
        worker.pipe = -1;  // poll() leaves it out
        int status = 0;
        sound &= ::waitpid(worker.child, &status, 0) == worker.child && status == 0;
        --running;
      }
      for (; worker.bytes.size() >= sizeof(DepthCase); worker.bytes.erase(0, sizeof(DepthCase))) {
        DepthCase one;
        std::copy_n(worker.bytes.data(), sizeof one, reinterpret_cast<char*>(&one));
        sink(one);
      }
    }
  }
  return sound ? Result<void>{} : fail("a case could not be run");
}

/// The cases that are asked for and not in `rows`.
Result<std::vector<std::uint32_t>> missing_cases(const DepthFlags& flags, const DepthRows& rows) {
  Shard shard;
  if (!flags.shard.empty()) {
    auto parsed = parse_shard(flags.shard);
    if (!parsed) return tl::unexpected(parsed.error());
    shard = *parsed;
  }
  std::set<std::uint32_t> made;
  for (const DepthCase& one : rows.cases) made.insert(one.index);
  std::vector<std::uint32_t> missing;
  for (std::uint32_t i = 0; i < case_count(rows.study); ++i) {
    if (i % shard.count == shard.part && made.erase(i) == 0) missing.push_back(i);
  }
  if (made.empty()) return missing;
  return fail("case " + std::to_string(*made.begin()) + " of " + flags.cases +
              ".partial is not asked for");
}

/// All that is asked for, what an interrupted run left of it included.
Result<DepthRows> run_all(const DepthStudy& study,
                          const DepthFlags& flags,
                          const Machine& machine) {
  DepthRows rows{.study = study, .known = true, .cases = {}, .makers = {}};
  auto kept = PartialRows::open(flags.cases, flags.resume);
  if (!kept) return tl::unexpected(kept.error());
  if (!kept->before().empty()) {
    auto before = read_depth_cases(kept->before(), kept->file(), rows);
    if (!before) return tl::unexpected(before.error());
  }
  const auto missing = missing_cases(flags, rows);
  if (!missing) return tl::unexpected(missing.error());
  if (auto begun = kept->begin(depth_cases_header()); !begun) {
    return tl::unexpected(begun.error());
  }
  const Progress progress = shown_progress(machine);
  std::size_t done = 0;
  auto made = run_on_cores(study, *missing, flags.cores, [&](const DepthCase& one) {
    kept->add(depth_case_row(study, one, machine.made_by));
    rows.cases.push_back(one);
    if (progress) progress(++done, missing->size());
  });
  if (!made) return tl::unexpected(made.error());
  std::sort(rows.cases.begin(), rows.cases.end(), [](const DepthCase& a, const DepthCase& b) {
    return a.index < b.index;
  });
  rows.makers.insert(machine.made_by);
  return rows;
}

std::string all_rows(const DepthRows& rows, const std::string& made_by) {
  std::string text = depth_cases_header();
  for (const DepthCase& one : rows.cases) text += depth_case_row(rows.study, one, made_by);
  return text;
}

/// What was asked for of these cases.
ExitStatus finish_depth(const DepthRows& rows, const DepthFlags& flags) {
  std::string makers;
  for (const std::string& one : rows.makers) makers += (makers.empty() ? "" : " and ") + one;
  const DepthStudy& study = rows.study;
  const std::string& csv = flags.csv.empty() ? flags.cases : flags.csv;
  for (const auto& [path, text] : {std::pair{flags.cases, all_rows(rows, makers)},
                                   std::pair{flags.report, depth_report(study, rows.cases, csv)},
                                   std::pair{flags.csv, depth_csv(rows.cases)}}) {
    if (path.empty()) continue;
    if (const auto written = config::write_whole_file(path, text); !written) {
      return {ExitCode::CannotOpen, "palp-lab: " + written.error().text};
    }
  }
  if (const auto drawn = plot::write_picture(depth_figure(study, rows.cases), flags.picture);
      !drawn) {
    return {ExitCode::CannotOpen, "palp-lab: " + drawn.error().text};
  }
  return {ExitCode::Done,
          depth_table(study, rows.cases) + "digest " + hexadecimal(digest_of(rows.cases)) + "\n"};
}

}  // namespace

void declare_depth(config::CommandLine& line, DepthFlags& flags) {
  line.text("--depths-mm", flags.depths_mm, "LIST", "the paper's ball at these depths: 5,10,15");
  line.whole("--count", flags.count, {.min = 1, .max = 100'000}, "random phantoms, and plain ones");
  line.whole("--repeats", flags.repeats, {.min = 1, .max = 100'000}, "of each listed depth");
  line.whole("--seed", flags.seed, {.min = 0, .max = 9007199254740991}, "of everything random");
  line.choice("--estimator", flags.estimator, {"bayes", "paper"}, "how strokes become a depth");
  line.whole("--taps", flags.taps, {.min = 1, .max = 100}, "over the inclusion");
  line.whole("--reference-taps", flags.reference_taps, {.min = 0, .max = 100}, "beside it, before");
  line.number("--rtt-ms", flags.rtt_ms, {.min = 0, .max = 5000, .unit = "ms"}, "round trip");
  line.number("--loss", flags.loss, {.min = 0, .max = 1}, "share of datagrams lost each way");
  line.text("--coupling",
            flags.coupling,
            "NAME",
            "instead of the standard scenario's: direct, wave, tdpa or mmt");
  line.toggle(
      "--wide", flags.wide, "as many phantoms from a range wider than the prior's, not a fifth");
  line.whole("--cores", flags.cores, {.min = 1, .max = 256}, "processes at a time");
  line.text("--shard", flags.shard, "I/N", "only every Nth case, from the Ith on");
  line.toggle("--resume", flags.resume, "only the cases that FILE.partial of --cases lacks");
  line.report(flags.report, "palp.depth/1");
  line.output("--cases", flags.cases, "every case to the bit, for merge and --resume");
  line.output("--csv", flags.csv, "a line per case");
  plot::declare_picture(line, flags.picture, "estimates, intervals and the truth");
  config::declare_submission(line, flags.submission);
}

ExitStatus run_depth(const DepthFlags& flags, const Machine& machine) {
  const auto study = study_of(flags);
  if (!study) return bad_input(study.error().text);
  auto can = config::can_write_files({flags.report, flags.csv, flags.cases});
  if (can) can = plot::can_write_picture(flags.picture);
  if (!can) {
    return {ExitCode::CannotOpen, "palp-lab: " + can.error().text};
  }
  const auto rows = run_all(*study, flags, machine);
  if (!rows) return refusal(rows.error());
  ExitStatus exit_status = finish_depth(*rows, flags);
  if (exit_status.code == ExitCode::Done) remove_partial_rows(flags.cases);
  return exit_status;
}

ExitStatus merge_depth(const std::vector<std::string>& files, const DepthFlags& flags) {
  DepthRows rows;
  for (const std::string& path : files) {
    const auto text = read_whole_file(path, kCasesSizeMax);
    if (!text) return {ExitCode::CannotOpen, "palp-lab: " + text.error().text};
    if (auto read = read_depth_cases(*text, path, rows); !read) {
      return refusal(read.error());
    }
  }
  if (auto whole = check_complete(rows); !whole) {
    return refusal(whole.error());
  }
  warn_of_makers({rows.makers.begin(), rows.makers.end()});
  return finish_depth(rows, flags);
}

}  // namespace palp::lab
