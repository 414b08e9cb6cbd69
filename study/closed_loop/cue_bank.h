#pragma once

#include <cstdint>
#include <vector>

#include "study/closed_loop/felt_observer.h"
#include "study/recovery.h"

/// What would be answered, foretold from few sessions: felt slopes, kept for some levels.
namespace palp::study {

/// How much stiffer an interval felt than the others [ln, as with the own finger], or later [ms],
/// session by session: the stronger one than each of the others; of a ranking each one than the one
/// before it; bias: the second than the first; yes or no: the one than plain tissue.
struct CueBank {
  using Differences = std::vector<double>;  ///< [-]; none: an interval told nothing

  Task task{};
  std::vector<double> levels{};                         ///< [-], rising
  std::vector<std::vector<Differences>> differences{};  ///< of each level, session by session
};

/// `levels` of either sign where the task is bias, as setting_of() has it; `count` sessions each.
[[nodiscard]] CueBank bank_of(const FeltSession& session,
                              const Judgement& judgement,
                              const Task& task,
                              const std::vector<double>& levels,
                              std::size_t count,
                              std::uint64_t seed,
                              const ForEachIndex& for_each_index);

/// Share [-] of "the second is stiffer", of "yes" or of right answers, lapses left out, at a level:
/// mean over the bank's sessions, interpolated between its levels.
[[nodiscard]] double banked_share(const CueBank& bank,
                                  const Judgement& judgement,
                                  int taps,
                                  double level) noexcept;

/// What is foretold of an observer.
struct Foretold {
  double jnd{};  ///< [-]; infinite: never told apart
  double pse{};  ///< [-], two-sided; not finite: nothing seems equal
};
/// From banked_share(): where a half and three quarters are, or half way from chance to certainty.
[[nodiscard]] Foretold banked(const CueBank& bank, const Judgement& judgement, int taps);

/// How what is felt follows what is there: felt difference = offset + gain * level, by least
/// squares over levels up to 0.6 of level_unit(). No difference was felt, or at one level only: 0.
struct FeltLine {
  double gain{};     ///< [-]; own finger: 1
  double offset{};   ///< [-]
  double scatter{};  ///< [-], standard deviation about the line, from session to session
};
[[nodiscard]] FeltLine line_of(const CueBank& bank);
/// JND of judgement and scatter together, over gain; criterion less offset, over gain.
[[nodiscard]] Foretold closed_form(const FeltLine& line,
                                   const Task& task,
                                   const Judgement& judgement,
                                   int taps) noexcept;

/// The same sessions, some of them more than once, others not: for bootstraps.
[[nodiscard]] CueBank resampled(const CueBank& bank, std::uint64_t seed, std::uint64_t stream);

}  // namespace palp::study
