#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "study/closed_loop/cue_bank.h"

namespace palp::study {

/// `palp-study foretell`, as given on the command line.
struct ForetellFlags {
  std::string file{};
  double weber{0.15};          ///< [-]
  std::uint64_t sessions{24};  ///< of each level of the bank
  std::uint64_t observers{6};  ///< 0: the forecast alone
  bool reads_exactly{};        ///< as Judgement has it
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

/// A level, and how often it is right, or "the second", or "yes", by the bank, without lapses.
struct Answered {
  double level{};  ///< [-]
  double share{};  ///< [-]
};

/// What observers of a condition are foretold, and what they show.
struct ForetoldRow {
  std::string condition{};
  /// By the estimator, or what is felt of a delay: no line, so a JND depends on what was asked.
  bool told{};
  FeltLine line{};
  std::vector<Answered> banked_shares{};
  Estimate banked_jnd{};
  Estimate closed_jnd{};
  Estimate banked_pse{};
  Estimate closed_pse{};
  Estimate whole_jnd{};
  Estimate whole_pse{};
  /// [m], tasks of detection: where a ball is found, by the bank; nothing: beyond the study's.
  std::optional<double> depth{};
  std::size_t trials{};   ///< in whole sessions; 0: none
  double yes{};           ///< [-], share of right answers, or of "the second"
  double yes_foretold{};  ///< [-], at the same levels, by the bank
  double yes_sd{};        ///< [-], of their difference, by chance in the sessions of both

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
