#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "review/excursions.h"
#include "review/site_data.h"
#include "review/tissue_table.h"

namespace palp::review {

enum class StrokeKind : std::uint8_t { Tap, Press };
inline constexpr Duration kTapMax{std::chrono::milliseconds{1500}};  ///< longer is a press

[[nodiscard]] constexpr const char* to_string(StrokeKind kind) noexcept {
  return kind == StrokeKind::Tap ? "tap" : "press";
}

/// One stroke as both sites saw it.
struct Tap {
  Place place;
  StrokeKind kind{};
  int index{};  ///< 1, 2, ... among the strokes of its kind at its place
  DepthEstimate estimate;
  Stiffness stiffness;
};

/// The strokes of the patient's file with what the surgeon felt in them: a stroke is the last
/// excursion of the hand that began before its estimate arrived at the surgeon's.
[[nodiscard]] std::vector<Tap> match_taps(const SiteData& surgeon,
                                          const SiteData& patient,
                                          const TissueTable* tissue);

/// All taps over the inclusion together.
struct OverallDepth {
  std::optional<DepthVerdict> verdict;  ///< nullopt: no tap there
  std::optional<double> depth;          ///< [m]
  std::optional<double> low;            ///< [m]
  std::optional<double> high;           ///< [m]
  std::optional<double> excluded;       ///< [m], as DepthEstimate::depth_low of verdict None
  std::string says;                     ///< for people
};
/// By estimator::summarise_depths() of the taps at B.
[[nodiscard]] OverallDepth judge_depth(const std::vector<Tap>& taps);

/// True if the estimator gave an interval: it does so by low below high.
[[nodiscard]] inline bool has_interval(const DepthEstimate& estimate) noexcept {
  return estimate.verdict == DepthVerdict::Found && estimate.depth_low < estimate.depth_high;
}

/// For people, one line each.
[[nodiscard]] std::string tap_table(const std::vector<Tap>& taps, const OverallDepth& depth);

}  // namespace palp::review
