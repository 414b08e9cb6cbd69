#pragma once

#include <string>

#include "study/recovery.h"

/// The statement that studies stand on: simulated observers whose traits are known go through every
/// method, and what comes back is held against targets.
namespace palp::study {

/// One claim: what was found, and between which numbers it has to lie.
struct Target {
  std::string what{};
  double found{};  ///< [-]
  double low{};    ///< [-]
  double high{};   ///< [-]
  [[nodiscard]] bool holds() const noexcept { return low <= found && found <= high; }
};

/// JND 0.08 to 0.30, lapses 0 to 5 %, `observers` >= 2 for each method; ten times as many, whose
/// answers cost next to nothing, say yes or no.
/// - QUEST+ at 60 trials: bias of ln JND 0.03 at most, its standard deviation 1.15 times the
///   1.385/sqrt(60) that Cramer and Rao allow an observer with 2 % of lapses at most;
/// - every method: 95 % intervals hold 93 to 97 % of the truths;
/// - yes or no at d' of 1, 1.5 and 2: bias of d' and of the criterion 0.03 at most, intervals
///   likewise.
[[nodiscard]] std::vector<Target> known_truth(std::size_t observers,
                                              std::uint64_t seed,
                                              const ForEachIndex& for_each_index);

/// Lines for people, one a target.
[[nodiscard]] std::string targets_text(std::span<const Target> targets);

}  // namespace palp::study
