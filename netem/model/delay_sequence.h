#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/random.h"
#include "common/core/time.h"
#include "netem/model/impairment.h"
#include "netem/model/nearest.h"
#include "netem/model/packet_outcome.h"
#include "netem/model/prepared_law.h"
#include "netem/model/trace_reader.h"

namespace palp::netem {

/// Mode exact: the delays as the law draws them, one datagram after the other.
/// Thread: its owner's, fit for rt.
class DelaySequence {
 public:
  struct Drawn {
    Duration delay{};
    bool floored{};  ///< the draw fell below the law's floor
  };

  DelaySequence(const PreparedLaw& law, const Streams& streams, TimePoint start) noexcept
      : streams_{streams}, stream_{streams.of(Stage::Delay)}, start_{start} {
    change(law);
  }
  /// From the next datagram on; `law` outlives this object or the next change.
  void change(const PreparedLaw& law) noexcept;
  /// Delays go this share of the way from the law to another one: mean and spread, in the shape of
  /// the law. @pre neither follows a trace.
  void lean(const PreparedLaw& towards, double share) noexcept;

  /// The next datagram, `index`, comes `gap` after the last one.
  void begin(std::uint64_t index, Duration gap) noexcept {
    index_ = index;
    z_before_ = z_;
    follows_ = begun_;
    if (source_ == Source::Correlated && gap != carry_gap_) correlate(gap);
  }
  /// Each delay hangs on the one before: one is drawn of each original, got through or not.
  [[nodiscard]] bool remembers() const noexcept { return source_ == Source::Correlated; }
  /// Of the original (copy 0), at most once, or of a copy that goes on at `onward`.
  [[nodiscard]] Drawn draw(std::size_t copy, TimePoint onward) noexcept {
    if (source_ == Source::Mean) return {nearest(mean_)};
    if (source_ == Source::Trace) return {traced(onward, copy)};
    const double drawn = mean_ + jitter_ * (copy == 0 ? around() : around(copy));
    return {nearest(std::max(drawn, least_)), drawn < least_};
  }

 private:
  /// Where a delay comes from.
  enum class Source : std::uint8_t { Mean, Trace, Correlated, Normal, Share };

  void choose_source(bool random) noexcept;
  void correlate(Duration gap) noexcept;
  void look_ahead() noexcept;
  [[nodiscard]] double fresh(RandomStream stream, std::uint64_t index) const noexcept;
  [[nodiscard]] double around(std::size_t copy) const noexcept;
  [[nodiscard]] Duration traced(TimePoint onward, std::size_t copy) noexcept;

  /// Of the original: [-], distance from the mean in units of the jitter.
  [[nodiscard]] double around() noexcept {
    if (index_ >= ahead_end_) look_ahead();
    const std::size_t place = kAhead - static_cast<std::size_t>(ahead_end_ - index_);
    z_ = normals_[place];
    return ahead_[place];
  }

  const PreparedLaw* law_{};
  Streams streams_;
  RandomStream stream_;
  TimePoint start_;
  std::uint64_t index_{};
  Source source_{Source::Mean};
  double mean_{};    ///< [ns], as it holds now, on a ramp too
  double jitter_{};  ///< [ns]
  double least_{};   ///< [ns], floor

  /// Drawn ahead for the originals whose indexes end below ahead_end_.
  static constexpr std::size_t kAhead = 32;
  std::array<double, kAhead> ahead_{};    ///< [-], around() of each; the last one's stands last
  std::array<double, kAhead> normals_{};  ///< [1], z of each, where delays are correlated
  std::size_t ahead_count_{};
  std::uint64_t ahead_end_{};
  double carry_{};          ///< [1], a of z_n = a z_(n-1) + sqrt(1 - a^2) e_n
  double share_{1};         ///< [1], sqrt(1 - a^2)
  Duration carry_gap_{-1};  ///< the gap that carry_ belongs to
  bool begun_{};            ///< there is a z_
  bool follows_{};          ///< there is a z_(n-1)
  double z_before_{};       ///< [1], z_(n-1)
  double z_{};              ///< [1], z_n, once drawn
  TraceReader trace_;
};

}  // namespace palp::netem
