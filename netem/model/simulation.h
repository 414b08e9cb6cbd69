#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "common/core/histogram.h"
#include "common/core/time.h"
#include "netem/model/impaired_path.h"
#include "netem/model/path_plan.h"

namespace palp::netem {

/// Datagram k is sent at k * interval, or, with a burst, so many with one stamp every burst *
/// interval.
struct SimulationConfig {
  PathPlan plan{};
  std::uint64_t packets{};
  Duration interval{};
  std::uint64_t burst{1};
  std::size_t frame_length{142};  ///< [bytes] as a qdisc counts them: payload + kFrameHeaders
  Direction direction{Direction::Up};
  std::uint64_t seed{1};
};

/// Brings decisions in the order of index, then copy, as recordings have them: where slots decide,
/// they come as the datagrams leave. Thread: its owner's; it allocates.
class DecisionOrder {
 public:
  using Sink = std::function<void(const Decision&)>;
  explicit DecisionOrder(Sink sink) : sink_{std::move(sink)} {}

  /// What push() said of one datagram.
  void decided(std::span<const Decision> decisions);
  /// One of them left, with the release that holds.
  void left(const Decision& decision);
  /// Tells the first `count` of those that wait with the releases they have, come what may.
  /// @returns how many copies are still to leave.
  std::uint64_t give_up(std::size_t count = std::numeric_limits<std::size_t>::max());
  /// Datagrams that are not told yet.
  [[nodiscard]] std::size_t waiting() const noexcept { return waiting_.size(); }

 private:
  struct Datagram {
    std::array<Decision, kCopiesMax> copies{};
    std::size_t count{};
    std::size_t open{};
  };
  void flush();

  Sink sink_;
  std::map<std::uint64_t, Datagram> waiting_;
};

/// What came of it, as decided.
struct SimulationResult {
  std::array<std::uint64_t, kVerdictCount> verdicts{};  ///< of originals
  std::uint64_t copies{};
  std::uint64_t corrupted{};  ///< delivered with a flipped bit
  std::uint64_t floored{};
  std::uint64_t reordered{};  ///< originals that arrive after one sent later (RFC 4737)
  std::uint64_t loss_runs{};  ///< of originals that did not arrive
  Histogram delay;            ///< of originals, release - arrival
  Histogram intended;         ///< as the law drew it
};

/// Runs it in no time at all. `each` is given every decision, by index and copy; empty: none is
/// told and none is kept. Not for rt.
[[nodiscard]] SimulationResult simulate(const SimulationConfig& config,
                                        const DecisionOrder::Sink& each = {});

/// Lines for people.
[[nodiscard]] std::string to_string(const SimulationResult& result);

/// The header and a line of a recording.
inline constexpr const char* kRecordingHeader = "index,sent_ns,arrived_ns,copy,verdict,flipped_bit";
/// `start` is 0 in the file. Without a line break.
void append_recording_line(std::string& text, const Decision& decision, TimePoint start);

}  // namespace palp::netem
