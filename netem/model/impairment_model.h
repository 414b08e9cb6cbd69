#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>

#include "common/core/time.h"
#include "netem/model/exact_model.h"
#include "netem/model/impairment.h"
#include "netem/model/kernel_model.h"
#include "netem/model/packet_outcome.h"

namespace palp::netem {

/// The outcomes of the datagrams of one direction, one after the other: a pure function of the
/// impairment, the seed, the direction and the arrival log; it never learns when anybody looks.
/// Each stage draws from its own stream by the datagram's index (or the stay's index), so a stage
/// that is switched on or off leaves all other draws as they were.
/// Thread: its owner's, fit for rt. Holds no datagrams: that is the Channel's.
class ImpairmentModel {
 public:
  /// `start`: where the blackouts' times begin.
  ImpairmentModel(const Impairment& impairment,
                  std::uint64_t seed,
                  Direction direction,
                  TimePoint start);

  /// The outcomes of the datagram and its copies, in the order they enter the line; valid until the
  /// next call.
  // NOLINTNEXTLINE(bugprone-exception-escape): never valueless, so no visit throws
  [[nodiscard]] std::span<const CopyOutcome> next(const Arrival& arrival) noexcept {
    return std::visit([&](auto& outcomes) { return outcomes.next(arrival); }, model_);
  }

  /// Calls `use` with the outcomes of the mode, whose next() is the one above: for who asks a
  /// million times.
  template <class Use>
  decltype(auto) with_model(Use&& use) {
    return std::visit(use, model_);
  }

  /// From the next datagram on another law holds; the streams go on where they are, so the future
  /// is not reshuffled. The mode must be the same. `law` outlives this object or the next change.
  void change(const PreparedLaw& law) noexcept;
  /// Delay, jitter and random losses go a share of the way; in mode exact only.
  void lean(const PreparedLaw& towards, double share) noexcept;
  /// Copies beside those of the law, of each datagram from now on; in mode exact only.
  void flood(std::size_t copies) noexcept;

  [[nodiscard]] const PreparedLaw& law() const noexcept { return *law_; }

 private:
  std::unique_ptr<const PreparedLaw> first_law_;
  const PreparedLaw* law_;  ///< that holds now
  std::variant<ExactModel, KernelModel> model_;
};

}  // namespace palp::netem
