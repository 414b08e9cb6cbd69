#pragma once

#include <cstddef>
#include <cstdint>

#include "common/core/random.h"
#include "common/core/time.h"
#include "netem/model/verdict.h"

namespace palp::netem {

enum class Direction : std::uint8_t { Up, Down };  ///< Up: surgeon to patient

inline constexpr std::size_t kCopiesMax = 17;  ///< the original, one duplicate and a flood

/// ECN's two bits of the type of service (RFC 3168): 0: cannot be marked, 3: is marked.
inline constexpr std::uint8_t kEcnMask = 3;

/// One line of the arrival log.
struct Arrival {
  TimePoint at{};                          ///< one before the last one's counts as the last one's
  std::size_t length{};                    ///< [bytes] of payload
  std::size_t room{};                      ///< places left for datagrams on their way
  std::uint8_t tos{};                      ///< IP's type of service: DSCP and ECN
  TimePoint held_until{TimePoint::min()};  ///< a stall from outside: it goes on no earlier
};

struct CopyOutcome {
  Verdict verdict{Verdict::Delivered};
  bool floored{};                ///< the law's draw fell below its floor
  bool immediate{};              ///< mode netem-6.1: goes ahead of the queue, slots included
  std::uint8_t tos{};            ///< as it leaves
  std::int32_t flipped_bit{-1};  ///< from 0 at the first byte of the frame; -1: none
  std::uint32_t length{};        ///< [bytes] of payload, as it leaves
  Duration delay{};     ///< as the law drew it; order, rate and stalls may hold it for longer
  TimePoint release{};  ///< set when delivered
};

/// What draws; each has a stream of its own in each direction and for each copy.
enum class Stage : std::uint8_t {
  Duplicate,
  Loss,
  Burst,
  StayState,
  StayLength,
  StayLoss,
  Delay,
  StateSteps,
  GemodelSteps,
  GemodelLoss,
  Corrupt,
  CorruptBit,
  Truncate,
  Reorder,
  Swap,
  StallGap,
  StallLength,
  Dither,
  Slot,
};

/// `seed` and `direction` once, then streams by stage and copy.
class Streams {
 public:
  Streams(std::uint64_t seed, Direction direction) noexcept
      : seed_{seed}, base_{kBase | (static_cast<std::uint64_t>(direction) << 16U)} {}

  [[nodiscard]] RandomStream of(Stage stage, std::size_t copy = 0) const noexcept {
    return {seed_, base_ | (static_cast<std::uint64_t>(stage) << 8U) | copy};
  }

 private:
  /// Keeps our streams apart from those of everybody else who draws with the same seed ("netem").
  static constexpr std::uint64_t kBase = 0x6e65'7465'6d00'0000ULL;
  std::uint64_t seed_;
  std::uint64_t base_;
};

}  // namespace palp::netem
