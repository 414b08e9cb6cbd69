#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/time.h"
#include "netem/model/impairment.h"
#include "netem/model/packet_outcome.h"
#include "netem/model/prepared_law.h"

namespace palp::netem {

/// ImpairmentModel's mode netem-6.1: what sch_netem of Linux 6.1 does to each packet, its defects
/// included, written from its documented semantics (tc-netem(8) and the order of its stages). Only
/// the random bits are ours: by number instead of one after the other.
/// Thread: its owner's, fit for rt.
class KernelModel {
 public:
  KernelModel(const PreparedLaw& law, const Streams& streams);

  [[nodiscard]] std::span<const CopyOutcome> next(const Arrival& arrival) noexcept;
  /// From the next packet on; `law` outlives this object or the next change.
  void change(const PreparedLaw& law) noexcept;

 private:
  /// A probability or a draw as Linux has it: of 2^32 - 1.
  using Share = std::uint32_t;

  /// Linux's correlated generator: the average of the new draw and the last answer. It narrows the
  /// distribution, so that small shares are hit too rarely.
  struct Correlated {
    Share rho{};
    Share last{};
    [[nodiscard]] Share next(Share draw) noexcept;
  };

  [[nodiscard]] Share draw(Stage stage, std::size_t copy) const noexcept;
  [[nodiscard]] bool loss_event(std::size_t copy) noexcept;
  [[nodiscard]] bool four_state_loss(Share draw) noexcept;
  [[nodiscard]] bool gemodel_loss(std::size_t copy) noexcept;
  /// Marks or loses; flips a bit. @returns false: lost.
  [[nodiscard]] bool survives(CopyOutcome& outcome, std::size_t copy) noexcept;
  void corrupt(CopyOutcome& outcome, std::size_t copy) noexcept;
  void enqueue(CopyOutcome& outcome, std::size_t copy, TimePoint now) noexcept;
  [[nodiscard]] Duration delay(std::size_t copy) noexcept;

  const PreparedLaw* law_;
  Streams streams_;
  std::uint64_t index_{};
  TimePoint last_at_{};
  bool first_{true};
  std::array<CopyOutcome, 2> copies_;

  Share duplicate_{};
  Share loss_{};
  Share corrupt_{};
  Share reorder_{};
  std::array<Share, 5> chain_{};  ///< a1..a5 of the 4-state chain, or of Gilbert-Elliott
  std::int32_t jitter_{};         ///< [ns]
  Correlated duplicate_state_;
  Correlated loss_state_;
  Correlated corrupt_state_;
  Correlated reorder_state_;
  Correlated delay_state_;
  std::uint8_t state_{1};
  std::uint32_t counter_{};
  TimePoint tail_{};  ///< the last release in the queue
};

/// What Linux draws from a distribution table for mean `mean` [ns] and scale `jitter` [ns]: the
/// entry at `draw` modulo the size, or, without a table, evenly from mean - jitter to mean +
/// jitter.
[[nodiscard]] std::int64_t kernel_delay(std::int64_t mean,
                                        std::int32_t jitter,
                                        std::span<const std::int16_t> table,
                                        std::uint32_t draw) noexcept;

/// The table behind a law of mode netem-6.1; empty: uniform.
[[nodiscard]] std::vector<std::int16_t> kernel_table(const DelayLaw& law);

}  // namespace palp::netem
