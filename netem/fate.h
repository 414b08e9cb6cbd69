#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/time.h"
#include "netem/impairment.h"

namespace palp::netem {

enum class Direction : std::uint8_t { Up, Down };  ///< Up: surgeon to patient

/// OverLimit: the line was full, or the datagram longer than link::kDatagramSizeMax.
enum class Verdict : std::uint8_t { Delivered, Lost, Blackout, OverLimit };
inline constexpr std::size_t kVerdictCount = 4;

inline constexpr std::size_t kCopiesMax = 2;  ///< the original and one duplicate

/// One line of the arrival log.
struct Arrival {
  TimePoint at{};        ///< one before the last one's counts as the last one's
  std::size_t length{};  ///< [bytes]
  std::size_t room{};    ///< places left for datagrams on their way
};

struct CopyFate {
  Verdict verdict{Verdict::Delivered};
  bool floored{};       ///< the law's draw fell below its floor
  Duration delay{};     ///< as the law drew it; the order may hold the datagram back for longer
  TimePoint release{};  ///< set when delivered
};

struct Fate {
  std::uint64_t index{};                    ///< 0, 1, ... of the datagram
  std::size_t count{1};                     ///< of `copies`; the first is the original
  std::array<CopyFate, kCopiesMax> copies;  ///< in the order they enter the line
};

/// The fates of the datagrams of one direction, one after the other: a pure function of the
/// impairment, the seed, the direction and the arrival log; it never learns when anybody looks.
/// Each stage draws from its own stream by the datagram's index (or the stay's index), so a stage
/// that is switched on or off leaves all other draws as they were. State is kept only where the
/// physics has one: bursts, stays, correlated delay, order.
/// Thread: its owner's, fit for rt. Holds no datagrams: that is the Channel's.
class FateSequence {
 public:
  /// `start`: where the blackouts' times begin.
  FateSequence(const Impairment& impairment,
               std::uint64_t seed,
               Direction direction,
               TimePoint start);

  [[nodiscard]] Fate next(const Arrival& arrival) noexcept;

 private:
  enum class Stage : std::uint8_t {
    Duplicate,
    Loss,
    Burst,
    StayState,
    StayLength,
    StayLoss,
    Delay
  };

  [[nodiscard]] std::uint64_t stream(Stage stage, std::size_t copy = 0) const noexcept;
  [[nodiscard]] bool hits(double probability, Stage stage, std::size_t copy) const noexcept;
  [[nodiscard]] bool in_blackout(TimePoint at) const noexcept;
  [[nodiscard]] bool in_burst(TimePoint at) noexcept;
  [[nodiscard]] double gilbert_loss(TimePoint at) noexcept;
  void enter_stay(TimePoint from) noexcept;
  void correlate(Duration gap) noexcept;
  void draw_delay(CopyFate& copy_fate, std::size_t copy) noexcept;
  [[nodiscard]] double draw_shape(std::size_t copy) noexcept;

  Impairment impairment_;
  std::uint64_t seed_;
  std::uint64_t base_stream_;
  TimePoint start_;

  std::uint64_t index_{};  ///< of the datagram being judged
  TimePoint last_at_{};
  bool first_{true};

  TimePoint burst_until_{};
  bool burst_seen_{};

  std::uint64_t stay_{};  ///< index of the present stay
  bool stay_is_bad_{};
  TimePoint stay_until_{};

  bool correlated_;
  double carry_{};          ///< [-], a of z_n = a z_(n-1) + sqrt(1 - a^2) e_n
  double fresh_{1};         ///< [-], sqrt(1 - a^2)
  Duration carry_gap_{-1};  ///< the gap that carry_ belongs to
  double z_before_{};       ///< [-], z_(n-1)
  double z_{};              ///< [-], z_n, once drawn

  TimePoint last_release_{};
};

}  // namespace palp::netem
