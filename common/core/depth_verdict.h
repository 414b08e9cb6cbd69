#pragma once

#include <cstdint>
#include <string_view>

namespace palp {

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

}  // namespace palp
