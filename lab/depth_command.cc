#include "lab/depth_command.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <type_traits>

#include <sys/wait.h>
#include <unistd.h>

#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/conventions.h"
#include "common/core/printable.h"

namespace palp::lab {
namespace {

using config::ExitCode;
using config::ExitStatus;

constexpr std::uint32_t kWideShare = 5;  // so many random phantoms for a wide one

ExitStatus bad_input(const std::string& sentence) {
  return {ExitCode::BadInput, "palp-lab: " + sentence};
}

Result<std::vector<double>> parse_depths(const std::string& text) {
  std::vector<double> out;
  std::string part;
  for (const char c : text + ",") {
    if (c != ',') {
      part += c;
      continue;
    }
    const auto value = config::parse_number(part);
    if (!value || !(*value >= 3 && *value <= 27)) {
      return fail("--depths-mm is \"" + printable(text) +
                  "\", expected numbers from 3 to 27 with commas between");
    }
    out.push_back(*value * kMillimetre);
    part.clear();
  }
  return out;
}

Result<DepthStudy> study_of(const DepthFlags& flags) {
  DepthStudy study{.depths = {},
                   .count = static_cast<std::uint32_t>(flags.count),
                   .repeats = static_cast<std::uint32_t>(flags.repeats),
                   .seed = flags.seed,
                   .estimator = flags.estimator == "paper" ? estimator::EstimatorKind::Paper
                                                           : estimator::EstimatorKind::Bayes,
                   .taps = static_cast<int>(flags.taps),
                   .reference_taps = static_cast<int>(flags.reference_taps),
                   .round_trip = flags.rtt_ms * 1e-3,
                   .loss = flags.loss,
                   .coupling = flags.coupling};
  study.wide_count = flags.wide ? study.count : study.count / kWideShare;
  if (flags.depths_mm.empty()) return study;
  auto depths = parse_depths(flags.depths_mm);
  if (!depths) return tl::unexpected(depths.error());
  study.depths = std::move(*depths);
  return study;
}

/// A process for each core: case i belongs to process i modulo their number.
struct Worker {
  pid_t child{};
  int pipe{};
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

[[noreturn]] void work(const DepthStudy& study, std::uint32_t first, std::uint32_t step, int to) {
  for (std::uint32_t i = first; i < case_count(study); i += step) {
    const auto one = run_case(study, i);
    if (!one) {
      std::fprintf(stderr, "palp-lab: %s\n", one.error().text.c_str());
      std::_Exit(2);
    }
    static_assert(std::is_trivially_copyable_v<DepthCase>);
    if (!write_all(to, reinterpret_cast<const char*>(&*one), sizeof(DepthCase))) std::_Exit(3);
  }
  std::_Exit(0);
}

Result<std::vector<DepthCase>> run_all(const DepthStudy& study, std::uint32_t cores) {
  std::vector<Worker> workers;
  for (std::uint32_t core = 0; core < cores; ++core) {
    int ends[2];
    if (::pipe(ends) != 0) return fail("cannot open a pipe to a process");
    const pid_t child = ::fork();
    if (child < 0) return fail("cannot start a process for each core");
    if (child == 0) work(study, core, cores, ends[1]);
    ::close(ends[1]);
    workers.push_back({child, ends[0]});
  }
  std::vector<DepthCase> cases;
  bool sound = true;
  for (const Worker& worker : workers) {
    std::string bytes;
    char chunk[4096];
    for (ssize_t got = 0; (got = ::read(worker.pipe, chunk, sizeof chunk)) > 0;) {
      bytes.append(chunk, static_cast<std::size_t>(got));
    }
    ::close(worker.pipe);
    int status = 0;
    sound &= ::waitpid(worker.child, &status, 0) == worker.child && status == 0;
    for (std::size_t at = 0; at + sizeof(DepthCase) <= bytes.size(); at += sizeof(DepthCase)) {
      DepthCase one;
      std::copy_n(bytes.data() + at, sizeof one, reinterpret_cast<char*>(&one));
      cases.push_back(one);
    }
  }
  if (!sound) return fail("a case could not be run");
  std::sort(cases.begin(), cases.end(), [](const DepthCase& a, const DepthCase& b) {
    return a.index < b.index;
  });
  return cases;
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
  line.text("--coupling", flags.coupling, "NAME", "instead of the standard scenario's");
  line.toggle(
      "--wide", flags.wide, "as many phantoms from a range wider than the prior's, not a fifth");
  line.whole("--cores", flags.cores, {.min = 1, .max = 256}, "processes at a time");
  line.report(flags.report, "palp.depth/1");
  line.text("--csv", flags.csv, "FILE", "a line per case");
  line.text("--svg", flags.svg, "FILE", "estimates, intervals and the truth");
}

ExitStatus run_depth(const DepthFlags& flags) {
  const auto study = study_of(flags);
  if (!study) return bad_input(study.error().text);
  if (const auto can = config::can_write_files({flags.report, flags.csv, flags.svg}); !can) {
    return {ExitCode::CannotOpen, "palp-lab: " + can.error().text};
  }
  const auto cases = run_all(*study, static_cast<std::uint32_t>(flags.cores));
  if (!cases) return bad_input(cases.error().text);
  for (const auto& [path, text] : {std::pair{flags.report, depth_report(*study, *cases, flags.csv)},
                                   std::pair{flags.csv, depth_csv(*cases)},
                                   std::pair{flags.svg, depth_svg(*study, *cases)}}) {
    if (path.empty()) continue;
    if (const auto written = config::write_whole_file(path, text); !written) {
      return {ExitCode::CannotOpen, "palp-lab: " + written.error().text};
    }
  }
  return {ExitCode::Done, depth_table(*study, *cases)};
}

}  // namespace palp::lab
