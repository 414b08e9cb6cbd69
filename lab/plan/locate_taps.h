#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "common/core/place.h"
#include "common/core/random.h"
#include "common/core/time.h"
#include "common/message/readings.h"
#include "depth/curve_match.h"
#include "depth/depth_database.h"
#include "depth/place_data.h"
#include "depth/stroke_tracker.h"
#include "patient_site/force_table.h"
#include "patient_site/phantom.h"
#include "patient_site/simulated_phantom.h"

namespace palp::lab {

/// What one phantom is.
struct LocatePhantom {
  depth::DepthDatabase::Query ball;
  Place axis;
  double scale{1};  ///< [-]
};

/// Draws of one case, in a fixed order.
class LocateDraws {
 public:
  LocateDraws(std::uint64_t seed, std::uint32_t index)
      : stream_{seed, 9300 + std::uint64_t{index}} {}
  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  double normal() { return stream_.normal(next_++); }
  std::uint64_t bits() { return stream_.bits(next_++); }

 private:
  RandomStream stream_;
  std::uint64_t next_{};
};

/// What a tip meets at one place: the curve on a ball's axis, of whose excess `share` [-] is left
/// at an indentation [m]; `scale` [-] of Young's modulus.
[[nodiscard]] patient::ForceTable table_at(const depth::DepthDatabase& database,
                                           const depth::DepthDatabase::Curve& curve,
                                           double scale,
                                           const std::function<double(double)>& share);

/// Takes every sample of a tap.
using Feel = std::function<void(const ContactSample&)>;

/// How a tip goes down and up again: a raised cosine.
struct TapMotion {
  double clearance{10e-3};  ///< [m], above the surface, where it begins
  double span{1};           ///< [s]
  double reach{4e-3};       ///< [m], below the surface
};

/// One tap from `now` on, no deeper than `reach_max` [m]; `config` says where, and what is there.
/// `motion`: nothing: from 10 mm, 3.6 to 4.2 mm deep within 0.7 to 1.4 s. @returns when the next
/// tap may begin.
[[nodiscard]] TimePoint tap(const patient::Phantom& phantom,
                            patient::SimulatedPhantomConfig config,
                            double reach_max,
                            const std::optional<TapMotion>& motion,
                            LocateDraws& draws,
                            TimePoint now,
                            const Feel& feel);

/// Taps of one palpation, one after the other; the tracker cuts their strokes. Thread: any one.
class Palpation {
 public:
  /// A tap at a place from `now` on. @returns when the next tap may begin.
  using TapAt = std::function<TimePoint(const Place& at, TimePoint now, const Feel& feel)>;

  /// `basis` outlives it; `stiffness`: of the tissue, beforehand.
  Palpation(const depth::CurveBasis& basis, const depth::StiffnessPrior& stiffness, TapAt tap_at)
      : basis_{&basis}, stiffness_{stiffness}, tap_at_{std::move(tap_at)} {}

  /// What all taps there say of the place; nothing: nothing was felt.
  [[nodiscard]] std::optional<depth::PlaceData> touch(const Place& at);

 private:
  const depth::CurveBasis* basis_;
  depth::StiffnessPrior stiffness_;
  TapAt tap_at_;
  depth::StrokeTracker tracker_{depth::StrokeTrackerConfig{}};
  TimePoint now_{};
};

}  // namespace palp::lab
