#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/time.h"
#include "netem/model/delay_data.h"

namespace palp::netem {

/// Exact: what the numbers say. Netem61: what Linux 6.1 does when it is told the same, its defects
/// included.
enum class Mode : std::uint8_t { Exact, Netem61 };

/// Uniform: between mean - jitter and mean + jitter. All others: jitter is the standard deviation
/// (in mode Netem61 the table's unit). Histogram: mean and jitter are unused.
enum class DelayShape : std::uint8_t {
  Uniform,
  Normal,
  Pareto,
  ParetoNormal,
  Gamma,
  LogNormal,
  Table,
  Histogram
};

/// Keep: nothing leaves before what came earlier. Netem: what is due first leaves first. Swap:
/// kept, but for some that overtake a few.
enum class Order : std::uint8_t { Keep, Netem, Swap };

/// Something that happens to a share of the datagrams.
struct Chance {
  double share{};        ///< [1]
  double correlation{};  ///< [1], 0..1, of successive datagrams
  bool operator==(const Chance&) const = default;
};

/// One-way delay of each datagram. A draw below floor * mean (never below 0) is lifted to it.
struct DelayLaw {
  Duration mean{};
  Duration jitter{};  ///< 0: constant, no draws are made
  DelayShape shape{DelayShape::Uniform};
  double floor{};               ///< [1], share of the mean, 0..1
  double correlation{};         ///< [1], 0..1, of successive datagrams; 0: independent
  Duration correlation_time{};  ///< > 0: correlation exp(-dt / this) at any sending rate
  DelayTable table;             ///< shape Table
  DelayHistogram histogram;     ///< shape Histogram
  bool operator==(const DelayLaw&) const = default;
};

/// The 4-state chain of tc (Salsano, Ludovici, Ordine 2009): 1 good, 2 good in a burst, 3 lost in
/// a burst, 4 a single loss.
struct FourStateLaw {
  double p13{};   ///< [1]
  double p31{1};  ///< [1]
  double p32{};   ///< [1]
  double p23{1};  ///< [1]
  double p14{};   ///< [1]
  bool operator==(const FourStateLaw&) const = default;
};

/// Gilbert-Elliott, one step for each datagram.
struct GemodelLaw {
  double to_bad{};     ///< [1], p
  double to_good{1};   ///< [1], r
  double loss_bad{1};  ///< [1], 1-h
  double loss_good{};  ///< [1], 1-k
  bool operator==(const GemodelLaw&) const = default;
};

/// After an exponential time of quiet, 1/rate in the mean, the next datagram begins a burst that
/// takes everything for `length`, that datagram included.
struct BurstLaw {
  double rate{};      ///< [1/s]
  Duration length{};  ///< 0: none
  bool operator==(const BurstLaw&) const = default;
};

/// Gilbert-Elliott in time: good and bad states last exponentially long, whatever the sending rate.
struct GilbertLaw {
  Duration good{};       ///< mean stay
  Duration bad{};        ///< mean stay; 0: none
  double loss_bad{1.0};  ///< [1], probability of loss in the bad state
  double loss_good{};    ///< [1]
  bool operator==(const GilbertLaw&) const = default;
};

/// Nothing that arrives in [from, from + length) gets through.
struct Blackout {
  Duration from{};  ///< from the channel's start
  Duration length{};
  bool operator==(const Blackout&) const = default;
};

/// From time to time everything that arrives is held to the end of the stall and then goes on in a
/// bunch. Lengths are log-normal.
struct StallLaw {
  double rate{};      ///< [1/s], of the begins, while no stall is on
  Duration median{};  ///< 0: none
  double spread{};    ///< [1], standard deviation of the logarithm
  bool operator==(const StallLaw&) const = default;
};

/// A datagram chosen with `chance`, when at least gap - 1 went by since the last one, skips the
/// delay.
struct ReorderLaw {
  Chance chance;
  std::uint32_t gap{};  ///< 0: none
  bool operator==(const ReorderLaw&) const = default;
};

/// Serialisation of one datagram after the other; with cells as ATM cuts them.
struct RateLaw {
  std::uint64_t bytes_per_s{};   ///< 0: none
  std::int32_t overhead{};       ///< [bytes] a datagram
  std::uint32_t cell{};          ///< [bytes], 0: none
  std::int32_t cell_overhead{};  ///< [bytes]
  bool operator==(const RateLaw&) const = default;
};

/// How much may wait for the rate. Each limit 0: none.
struct QueueLaw {
  std::uint64_t packets{};
  std::uint64_t bytes{};
  Duration wait{};
  bool codel{};  ///< RFC 8289
  Duration target{std::chrono::milliseconds{5}};
  Duration interval{std::chrono::milliseconds{100}};
  bool operator==(const QueueLaw&) const = default;
};

/// Datagrams leave at the beginnings of slots only, so many in each.
struct SlotLaw {
  Duration min{};                   ///< from one slot to the next ...
  Duration max{};                   ///< ... uniform up to this; 0: no slots
  std::optional<DelayLaw> spacing;  ///< instead: drawn from this law
  std::uint64_t packets{};          ///< 0: any number
  std::uint64_t bytes{};            ///< 0: any number
  bool operator==(const SlotLaw&) const = default;
};

/// What happens to the datagrams of one direction. A value; frozen once a Channel has it. One list:
/// a law or a number for each word that can be asked for.
struct Impairment {
  Mode mode{Mode::Exact};
  DelayLaw delay;
  DelayTrace trace;  ///< with points: instead of the delay law
  Recording replay;  ///< with rows: instead of everything else
  Chance loss;
  std::optional<FourStateLaw> state;
  std::optional<GemodelLaw> gemodel;
  BurstLaw burst;
  GilbertLaw gilbert;
  LossBitmap bitmap;
  bool ecn{};                   ///< a loss of a datagram that can carry the mark marks it instead
  Chance duplicate;             ///< one copy, with losses and delay of its own
  Chance corrupt;               ///< one bit is flipped ...
  bool corrupt_payload{};       ///< ... behind the headers only
  Chance truncate;              ///< cut off ...
  std::uint64_t truncate_to{};  ///< [bytes] ... to this much payload
  ReorderLaw reorder;
  RateLaw rate;
  QueueLaw queue;
  SlotLaw slot;
  std::uint64_t limit{};  ///< datagrams on their way; 0: the mode's (1000 in Netem61, else none)
  std::uint64_t mtu{};    ///< [bytes] with the IP header; longer ones are dropped; 0: none
  StallLaw stall;
  std::vector<Blackout> blackouts;
  bool dscp_clear{};
  Order order{Order::Keep};
  Chance swap;                 ///< order Swap: who overtakes ...
  std::uint32_t swap_depth{};  ///< ... and how many
  bool operator==(const Impairment&) const = default;
};

inline constexpr std::size_t kBlackoutsMax = 16;
inline constexpr std::uint32_t kSwapDepthMax = 64;
/// Longest time that can be asked for (11 days).
inline constexpr Duration kTimeMax{std::chrono::seconds{1'000'000}};
/// Shortest mean stay in a Gilbert-Elliott state: bounds the work per datagram.
inline constexpr Duration kStayMin{std::chrono::microseconds{100}};
inline constexpr double kBurstRateMax = 1e6;  ///< [1/s]
/// Ethernet, IPv4 and UDP around a datagram, as a qdisc counts them; the first 14 are not IP's.
inline constexpr std::size_t kFrameHeaders = 42;
inline constexpr std::size_t kEthernetHeader = 14;

}  // namespace palp::netem
