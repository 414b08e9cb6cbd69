#pragma once

#include <cstdint>
#include <string_view>

#include "common/core/time.h"

/// What goes into a depth estimator and what comes out of it.
namespace palp {

/// One measured point, as the devices gave it. The force carries its sensor's pole and the tip does
/// not: whoever compares them gives the tip the same, or contact looks like hysteresis.
struct ContactSample {
  TimePoint at{};
  double position{};        ///< [m], tip; the surface is the estimator's to find
  double force{};           ///< [N], as measured
  double lateral{};         ///< [m]
  Duration position_age{};  ///< of the tip's reading at `at`
  Duration force_age{};     ///< of the force's
};

/// Found: an inclusion at `depth`. None: there is no inclusion in reach. Invalid: no statement.
enum class DepthVerdict : std::uint8_t { None, Found, Invalid };
inline constexpr int kDepthVerdictCount = 3;

[[nodiscard]] constexpr std::string_view to_string(DepthVerdict verdict) noexcept {
  switch (verdict) {
    case DepthVerdict::None:
      return "none";
    case DepthVerdict::Found:
      return "found";
    case DepthVerdict::Invalid:
      return "invalid";
  }
  return "?";
}

/// Why a stroke gave no estimate.
enum class DepthReason : std::uint8_t {
  Ok,
  StrokeTooShort,  ///< too little indentation to fit eq. (2)
  StrokeTooFewSamples,
  StrokeNotMonotone,
  NoContact,  ///< the surface could not be found
  ForceSaturated,
  HashOutOfRange,  ///< outside the range in which eq. (3) holds
  TooNoisy,        ///< the force's noise hides what an inclusion adds
};
inline constexpr int kDepthReasonCount = 8;

[[nodiscard]] constexpr std::string_view to_string(DepthReason reason) noexcept {
  switch (reason) {
    case DepthReason::Ok:
      return "";
    case DepthReason::StrokeTooShort:
      return "stroke too short";
    case DepthReason::StrokeTooFewSamples:
      return "too few samples";
    case DepthReason::StrokeNotMonotone:
      return "stroke not monotone";
    case DepthReason::NoContact:
      return "no contact found";
    case DepthReason::ForceSaturated:
      return "force saturated";
    case DepthReason::HashOutOfRange:
      return "hash outside the range of eq. (3)";
    case DepthReason::TooNoisy:
      return "force too noisy";
  }
  return "?";
}

/// The result of one stroke (contact to reversal).
struct DepthEstimate {
  std::uint32_t number{};  ///< 1, 2, ... in this session; 0: none yet
  TimePoint stroke_began_at{};
  TimePoint stroke_ended_at{};
  double lateral{};          ///< [m]
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

}  // namespace palp
