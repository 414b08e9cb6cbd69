#pragma once

#include <cstddef>
#include <cstdint>

#include "study/psychometric.h"
#include "study/track.h"

namespace palp::study {

/// Answers from the psychometric function alone: for tests of methods and fits. The nth answer
/// depends on (seed, stream, n) and the level alone.
struct FormulaObserver {
  Task task{};
  ObserverTraits traits{};
  std::uint64_t seed{};
  std::uint64_t stream{};

  /// "Yes" as in Answers.
  [[nodiscard]] bool answer(double level, std::size_t index) const noexcept;
};

/// Until the track is done; its trials, pooled by level.
std::vector<Answers> run_track(Track& track, const FormulaObserver& observer);

}  // namespace palp::study
