#pragma once

#include <cstddef>
#include <cstdint>

#include "netem/model/impairment.h"
#include "netem/model/loss_laws.h"
#include "netem/model/packet_outcome.h"

namespace palp::netem {

/// What befalls one copy of a datagram by chance.
struct Chances {
  bool duplicate{};
  bool lost{};
  bool swept{};           ///< lost, and all its copies
  double loss_gemodel{};  ///< [1], of each of them
  bool cut{};
  bool flipped{};
  bool jumps{};  ///< goes ahead of its delay
  bool swaps{};  ///< overtakes some
  bool operator==(const Chances&) const = default;
};

/// Mode exact: all that strikes a datagram by chance. Every process knows of every datagram,
/// whatever the others say: their states do not depend on each other. For long runs of datagrams
/// none has anything to say; who asks quiet() first need not ask next() about those.
/// Thread: its owner's, fit for rt.
class ChanceDraw {
 public:
  ChanceDraw(const Impairment& law, const Streams& streams) noexcept;
  /// From datagram `index` on; `law` outlives this object or the next change.
  void change(const Impairment& law, std::uint64_t index) noexcept;
  /// From datagram `index` on random losses, duplicates and flipped bits go this share of the way
  /// to another law's; runs that are going on go on.
  void lean(const Impairment& towards, double share, std::uint64_t index) noexcept;

  /// No chance strikes datagram `index`.
  [[nodiscard]] bool quiet(std::uint64_t index) const noexcept { return index < quiet_end_; }
  /// quiet() says no till next() has been asked again.
  void wake() noexcept { quiet_end_ = 0; }
  /// What befalls the original of datagram `index`; above the last one asked about. Those between
  /// were quiet.
  [[nodiscard]] Chances next(std::uint64_t index) noexcept;
  /// What befalls its copy `copy`, from 1: a sibling that leaves no trace.
  [[nodiscard]] Chances of_copy(const Chances& original,
                                std::size_t copy,
                                std::uint64_t index) const noexcept;

 private:
  void catch_up(std::uint64_t index) noexcept;
  [[nodiscard]] bool jumps() noexcept;
  [[nodiscard]] std::uint64_t quiet_run() const noexcept;

  const Impairment* law_;
  Streams streams_;
  std::uint64_t quiet_end_{};  ///< below this index no chance strikes
  std::uint64_t asked_{};      ///< up to this index the processes have been asked or told
  std::uint32_t since_reorder_{};
  ChanceProcess duplicate_;
  ChanceProcess loss_;
  ChanceProcess corrupt_;
  ChanceProcess truncate_;
  ChanceProcess reorder_;
  ChanceProcess swap_;
  FourStateProcess state_;
  GemodelProcess gemodel_;
};

}  // namespace palp::netem
