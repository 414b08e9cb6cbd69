#pragma once

#include <cstdint>
#include <string>

#include "common/config/command_line.h"
#include "study/closed_loop/cue_bank.h"

namespace palp::study {

/// `palp-study foretell`, as given on the command line.
struct ForetellFlags {
  std::string file{};
  double weber{0.15};          ///< [-]
  std::uint64_t sessions{12};  ///< of each level of the bank
  std::uint64_t observers{6};  ///< 0: the forecast alone
  std::string report{};
};

void declare_foretell(config::CommandLine& line, ForetellFlags& flags);
/// Exit code 1: what observers of whole sessions show is not what was foretold.
[[nodiscard]] config::ExitStatus run_foretell(const ForetellFlags& flags,
                                              const ForEachIndex& for_each_index);

/// A number and its 95 % interval.
struct Estimate {
  double value{};  ///< [-]
  double low{};    ///< [-]
  double high{};   ///< [-]
};

/// What observers of a condition are foretold, and what they show.
struct ForetoldRow {
  std::string condition{};
  FeltLine line{};
  Estimate banked_jnd{};
  Estimate closed_jnd{};
  Estimate banked_pse{};
  Estimate closed_pse{};
  Estimate whole_jnd{};
  Estimate whole_pse{};
  std::size_t trials{};   ///< in whole sessions; 0: none
  double yes{};           ///< [-], share of right answers, or of "the second"
  double yes_foretold{};  ///< [-], at the same levels, by the bank
  double yes_sd{};        ///< [-], of the share

  /// By 2.58 standard deviations (1 % on chance's account): the answers are as often right as
  /// foretold; where a JND was foretold, it is that one, by the bank and by the closed form, and
  /// the PSE likewise.
  [[nodiscard]] bool holds(bool two_sided) const noexcept;
};

/// One condition: its bank, and `observers` who feel whole sessions.
[[nodiscard]] Result<ForetoldRow> foretell(const Study& study,
                                           std::size_t condition,
                                           const ForetellFlags& flags,
                                           const ForEachIndex& for_each_index);

}  // namespace palp::study
