#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/config/command_line.h"
#include "study/data_set.h"
#include "study/formula_participant.h"
#include "study/recovery.h"

namespace palp::study {

/// Whose trials are given at real sites.
inline constexpr std::string_view kPerson = "person";

/// A person's device, as for palp-surgeon.
struct HandFlags {
  std::string master{"pointer"};
  std::string devices{};             ///< file; empty: none is needed
  std::uint64_t monitor_port{8080};  ///< 0: any free one
};

/// `palp-study run`, as given on the command line.
struct RunFlags {
  std::string folder{};
  std::optional<std::uint64_t> participant{};  ///< from 1; nothing: all
  std::string observer{"formula"};
  PeopleTraits people{};
  HandFlags hand{};
  bool each{};
};

void declare_run(config::CommandLine& line, RunFlags& flags);

/// Which observers go through a study: made once the study is known.
using MakeObserver = std::function<Result<Observer>(const Study& study)>;

/// Goes on where an earlier run stood. Every answer is on the disk before the next trial begins.
/// `say`: a line for people, from any thread, one at a time.
[[nodiscard]] config::ExitStatus run_run(const RunFlags& flags,
                                         const MakeObserver& make_observer,
                                         const ForEachIndex& for_each_index,
                                         const std::function<void(const std::string&)>& say);

}  // namespace palp::study
