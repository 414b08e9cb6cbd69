#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/time.h"
#include "netem/model/impairment.h"
#include "netem/model/packet_outcome.h"

namespace palp::netem {

/// Gives each datagram the outcome that a recording had for its number. Thread: its owner's, fit
/// for rt.
class RecordingReader {
 public:
  /// Another recording, or the same from anywhere.
  void rewind() noexcept { lost_ = true; }
  /// The outcomes of datagram `index`, which comes at `at`, and its copies; beyond the recording
  /// those of a perfect link. Numbers rise. @returns how many were put in front of `into`.
  [[nodiscard]] std::size_t outcomes(const Recording& recording,
                                     std::uint64_t index,
                                     TimePoint at,
                                     const Arrival& arrival,
                                     std::span<CopyOutcome> into) noexcept;

 private:
  std::size_t at_{};  ///< the next row ...
  bool lost_{true};   ///< ... which has to be looked for
};

}  // namespace palp::netem
