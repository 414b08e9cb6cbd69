#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "common/core/time.h"

namespace palp::netem {

/// Uniform: between mean - jitter and mean + jitter. Normal: jitter is the standard deviation.
enum class DelayShape : std::uint8_t { Uniform, Normal };

/// Keep: nothing leaves before what came earlier. Free: what is due first leaves first.
enum class Order : std::uint8_t { Keep, Free };

/// One-way delay of each datagram. A draw below floor * mean (never below 0) is lifted to it.
struct DelayLaw {
  Duration mean{};
  Duration jitter{};  ///< 0: constant, no draws are made
  DelayShape shape{DelayShape::Uniform};
  double floor{};               ///< [1], share of the mean, 0..1
  double correlation{};         ///< [1], 0..1, of successive datagrams; 0: independent
  Duration correlation_time{};  ///< > 0: correlation exp(-dt / this) at any sending rate
  bool operator==(const DelayLaw&) const = default;
};

/// While no burst is on, one starts with probability rate * dt per datagram and takes everything
/// for `length`, the datagram that started it included.
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

/// What happens to the datagrams of one direction. A value; frozen once a Channel has it.
/// The parts act independently, in this order: duplicate, blackout, losses, delay, order.
struct Impairment {
  DelayLaw delay;
  double loss{};  ///< [1], independent
  BurstLaw burst;
  GilbertLaw gilbert;
  double duplicate{};  ///< [1], probability of one copy, with losses and delay of its own
  std::vector<Blackout> blackouts;
  Order order{Order::Keep};
  bool operator==(const Impairment&) const = default;
};

inline constexpr std::size_t kBlackoutsMax = 16;
/// Longest time that can be asked for (11 days).
inline constexpr Duration kTimeMax{std::chrono::seconds{1'000'000}};
/// Shortest mean stay in a Gilbert-Elliott state: bounds the work per datagram.
inline constexpr Duration kStayMin{std::chrono::microseconds{100}};
inline constexpr double kBurstRateMax = 1e6;  ///< [1/s]

/// The words of an impairment, in any order (`none`, or an empty text: a perfect link):
///
///     delay MEAN [JITTER [CORRELATION]] [distribution uniform|normal] [floor SHARE]
///           [correlation-time TIME]
///     loss [random] SHARE
///     loss burst RATE LENGTH               RATE as 0.2/s
///     loss gilbert-time GOOD BAD [LOSS_IN_BAD [LOSS_IN_GOOD]]
///     duplicate SHARE
///     blackout FROM LENGTH                 may be repeated
///     order keep|free
///
/// Times carry ns, us, ms or s (with tc's spellings usec, msec, sec ...), shares a `%`. A bare
/// number is refused: tc reads a bare time as microseconds, people mean milliseconds.
/// @returns or one sentence with the column (from 1), the word and what was expected.
[[nodiscard]] Result<Impairment> parse_impairment(std::string_view text);

/// The words that parse back to exactly the same impairment.
[[nodiscard]] std::string to_string(const Impairment& impairment);

/// The plain link law of the laboratory, for `--delay-ms --jitter-ms --loss`:
/// max(0.2 delay, delay + jitter * N(0, 1)), order free, `loss` [1] independent.
[[nodiscard]] Result<Impairment> impairment_from_delay(Duration delay,
                                                       Duration jitter,
                                                       double loss);

/// The same with half of a round trip as delay, for `--rtt-ms`; `jitter` stays that of one way.
[[nodiscard]] Result<Impairment> impairment_from_rtt(Duration rtt, Duration jitter, double loss);

}  // namespace palp::netem
