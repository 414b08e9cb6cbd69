#pragma once

#include <vector>

#include "judge/metrics.h"
#include "surgeon_site/gesture_script.h"

namespace palp::review {

/// Says to which tap or hold of a script an instant of script time belongs.
class PhaseFinder {
 public:
  /// The script outlives the finder.
  explicit PhaseFinder(const surgeon::GestureScript& script);
  /// `hand`: where it is. A search goes where nobody knew beforehand.
  [[nodiscard]] judge::PhaseTag at(Duration script_time, const Place& hand) noexcept {
    return find(script_time, hand).tag;
  }
  /// The same with its exact times.
  struct Found {
    judge::PhaseTag tag;
    Duration began_at{};  ///< script time
    Duration duration{};
  };
  [[nodiscard]] Found find(Duration script_time, const Place& hand) noexcept;

 private:
  struct Entry {
    Duration began_at{};
    Duration ends_at{};
    judge::PhaseTag tag;
    bool searches{};
  };
  std::vector<Entry> entries_;
  std::size_t present_{};  ///< where the last answer was found: time mostly goes on by one tick
};

}  // namespace palp::review
