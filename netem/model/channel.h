#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/core/histogram.h"
#include "common/core/time.h"
#include "common/link/transport.h"
#include "netem/model/impaired_path.h"
#include "netem/model/impairment.h"
#include "netem/model/path_plan.h"

namespace palp::netem {

/// pushed + copies = popped + lost + header_hit + blackout + over_limit + in flight, at any moment.
struct ChannelCounters {
  std::uint64_t pushed{};  ///< datagrams that arrived
  std::uint64_t copies{};  ///< duplicates made of them
  std::uint64_t popped{};
  std::uint64_t lost{};
  std::uint64_t header_hit{};  ///< a bit flipped in its headers: no socket would have got it
  std::uint64_t blackout{};
  std::uint64_t over_limit{};  ///< line or queue full, datagram too long, or nobody collected
  std::uint64_t corrupted{};   ///< delivered with a flipped bit
  std::uint64_t reordered{};   ///< originals popped after one that had arrived later
  std::uint64_t floored{};     ///< delays lifted to the law's floor
};

/// A datagram that leaves the channel.
struct Released {
  std::size_t size{};  ///< [bytes]
  TimePoint arrived_at{};
  TimePoint released_at{};  ///< as decided, however late it is collected
  std::uint64_t index{};    ///< of the datagram, in order of arrival from 0
  bool duplicate{};
  Decision decision;  ///< all of it
};

/// One direction of an impaired path; the same object under real sockets and in virtual time: a
/// ImpairedPath, which decides, and the datagrams themselves.
/// What leaves, when and in what order depends on the pushes alone, never on how often anybody
/// pops. At most `in_flight_max` datagrams are on their way; somewhat more may wait, due, for a
/// host that does not collect them.
/// Thread: its owner's, fit for rt: all memory is taken by the constructor.
class Channel {
 public:
  /// `start`: where the times of the plan and of blackouts begin. The impairment must be one that
  /// parse_impairment could have made; in_flight_max > 0.
  Channel(const Impairment& impairment,
          std::uint64_t seed,
          Direction direction,
          std::size_t in_flight_max,
          TimePoint start = {});
  /// `datagram_max` [bytes]: longer datagrams are over the limit.
  Channel(const PathPlan& plan,
          std::uint64_t seed,
          Direction direction,
          std::size_t in_flight_max,
          TimePoint start,
          std::size_t datagram_max);

  /// A datagram arrives. A `now` before the newest one counts as that.
  /// @returns what was decided; valid until the next call.
  std::span<const Decision> push(std::span<const std::byte> datagram,
                                 TimePoint now,
                                 std::uint8_t tos = 0) noexcept;

  /// @returns nullopt: the channel is empty.
  [[nodiscard]] std::optional<TimePoint> next_release() const noexcept {
    return path_.next_release();
  }

  /// The next datagram due at `now`, cut off at the size of `out`. @returns nullopt: nothing due.
  std::optional<Released> pop(std::span<std::byte> out, TimePoint now) noexcept;
  /// The same without a copy: its bytes, damage done, are valid until the next push.
  struct InPlace {
    Decision decision;
    std::span<const std::byte> bytes;
  };
  std::optional<InPlace> pop_in_place(TimePoint now) noexcept;

  /// See ImpairedPath::apply().
  void apply(PreparedChange& change, TimePoint now) noexcept { path_.apply(change, now); }

  [[nodiscard]] const ChannelCounters& counters() const noexcept { return counters_; }
  /// Inside the channel: on their way, or due and not collected.
  [[nodiscard]] std::size_t in_flight() const noexcept { return path_.in_flight(); }
  [[nodiscard]] const ImpairedPath& impaired_path() const noexcept { return path_; }
  /// Delays as the law drew them, of what was delivered.
  [[nodiscard]] const Histogram& intended_delay() const noexcept { return intended_; }
  /// Release minus arrival, of what was popped: with order keep also the wait behind others.
  [[nodiscard]] const Histogram& achieved_delay() const noexcept { return achieved_; }

 private:
  void count(const Decision& decision) noexcept;

  ImpairedPath path_;
  std::size_t datagram_max_;
  std::unique_ptr<std::byte[]> bytes_;

  ChannelCounters counters_;
  std::uint64_t index_next_{};  ///< one above the highest original popped
  Histogram intended_;
  Histogram achieved_;
};

}  // namespace palp::netem
