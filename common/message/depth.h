#pragma once

#include <cstdint>

#include "common/core/depth_verdict.h"
#include "common/core/place.h"
#include "common/core/time.h"
#include "common/message/enumerators.h"
#include "common/message/field.h"
#include "common/message/limits.h"

/// What goes into a depth estimator, what comes out of it, and what of that crosses.
namespace palp {

/// One measured point, as the devices gave it. The force carries its sensor's pole and the tip does
/// not: whoever compares them gives the tip the same, or contact looks like hysteresis.
struct ContactSample {
  TimePoint at{};
  double position{};  ///< [m], tip; the surface is the estimator's to find
  double force{};     ///< [N], as measured
  Place place;
  Duration position_age{};  ///< of the tip's reading at `at`
  Duration force_age{};     ///< of the force's
  std::uint64_t session{};  ///< id of the link's; with another one it may be another patient
};

/// The result of one stroke (contact to reversal).
struct DepthEstimate {
  std::uint32_t number{};  ///< 1, 2, ... in this session; 0: none yet
  TimePoint stroke_began_at{};
  TimePoint stroke_ended_at{};
  Place place;
  double indentation_max{};  ///< [m]
  double force_max{};        ///< [N]
  double surface{};          ///< [m], as found
  DepthVerdict verdict{DepthVerdict::Invalid};
  DepthReason reason{DepthReason::Ok};
  double hash{};          ///< [N], the paper's h: the cubic (2) at 1 mm
  double depth{};         ///< [m], top of the inclusion below the undeformed surface
  double depth_stddev{};  ///< [m]; 0: this estimator gives none
  /// [m], 95 % interval; equal to depth: this estimator gives none. Verdict None: an inclusion of
  /// 5 mm radius or more whose top lies above this would have shown; 0: nothing is excluded.
  double depth_low{};
  double depth_high{};  ///< [m]
  double fit_rms{};     ///< [N]
};

/// The latest result of the depth estimator; repeated in every telegram until replaced.
struct DepthReport {
  std::uint32_t number{};  ///< of the estimate, 0: none yet
  DepthVerdict verdict{};
  DepthReason reason{};
  double depth{};         ///< [m], top of the inclusion below the undeformed surface
  double depth_stddev{};  ///< [m]
  double depth_low{};     ///< [m]
  double depth_high{};    ///< [m]
  double hash{};          ///< [N]
  Place place{};          ///< where the stroke was
};

namespace message {

template <std::same_as<DepthEstimate> S>
inline constexpr auto fields<S> = list({.log = "DepthEstimate"},
                                       field<1, &S::number>("number"),
                                       field<2, &S::stroke_began_at>("stroke_began_at_ns"),
                                       field<3, &S::stroke_ended_at>("stroke_ended_at_ns"),
                                       field<4, &S::place, &Place::x>("x_m"),
                                       field<5, &S::indentation_max>("indentation_max_m"),
                                       field<6, &S::force_max>("force_max_n"),
                                       field<7, &S::surface>("surface_m"),
                                       field<8, &S::verdict>("verdict"),
                                       field<9, &S::reason>("reason"),
                                       field<10, &S::hash>("hash_n"),
                                       field<11, &S::depth>("depth_m"),
                                       field<12, &S::depth_stddev>("depth_stddev_m"),
                                       field<13, &S::depth_low>("depth_low_m"),
                                       field<14, &S::depth_high>("depth_high_m"),
                                       field<15, &S::fit_rms>("fit_rms_n"),
                                       field<16, &S::place, &Place::y>("y_m"));

/// In the log the hash stands before the depths.
template <std::same_as<DepthReport> S>
inline constexpr auto fields<S> = list(
    {.wire = "Depth"},
    field<1, &S::number>("number"),
    field<2, &S::verdict>("verdict"),
    field<3, &S::reason>("reason"),
    field<4, &S::depth>("depth_m", wire<float>, limit(kLengthMax), log_number<5>),
    field<5, &S::depth_stddev>("depth_stddev_m", wire<float>, limit(kLengthMax), log_number<6>),
    field<6, &S::depth_low>("depth_low_m", wire<float>, limit(kLengthMax), log_number<7>),
    field<7, &S::depth_high>("depth_high_m", wire<float>, limit(kLengthMax), log_number<8>),
    field<8, &S::hash>("hash_n", wire<float>, limit(kForceMax), log_number<4>),
    field<9, &S::place, &Place::x>("x_m", wire<float>, limit(kLengthMax)),
    field<10, &S::place, &Place::y>("y_m", wire<float>, limit(kLengthMax)));

}  // namespace message
}  // namespace palp
