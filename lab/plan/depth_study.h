#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "lab/plan/depth_bound.h"
#include "lab/run/scenario.h"

namespace palp::lab {

/// What the estimator knows of the inclusion beforehand: the paper's ball exactly, or a range (of
/// random phantoms the one they are drawn from).
enum class Knowledge : std::uint8_t { Ball, Range };
[[nodiscard]] constexpr std::string_view to_string(Knowledge knowledge) noexcept {
  return knowledge == Knowledge::Ball ? "ball" : "range";
}

/// Monte Carlo of whole palpations: reference taps beside, then taps over an inclusion, through
/// hand, coupling, network, servo and sensor, in virtual time.
struct DepthStudy {
  /// [m], the paper's phantom at these, each palpation judged with both kinds of knowledge; empty:
  /// random phantoms
  std::vector<double> depths{};
  std::uint32_t count{100};    ///< random phantoms with, and as many without an inclusion
  std::uint32_t wide_count{};  ///< and beside them so many from a range wider than the prior's
  std::uint32_t repeats{1};    ///< of each depth
  std::uint64_t seed{1};
  depth::EstimatorKind estimator{depth::EstimatorKind::Bayes};
  int taps{4};
  int reference_taps{4};
  double round_trip{};     ///< [s]
  double loss{};           ///< [-], each way
  std::string coupling{};  ///< empty: the scenario's
};

/// One palpation and what was said of it. Plain memory: it crosses a pipe between processes.
struct DepthCase {
  std::uint32_t index{};
  bool inclusion{};
  bool wide{};  ///< from the wider range
  Knowledge knowledge{Knowledge::Range};
  DepthVerdict verdict{DepthVerdict::Invalid};
  double depth{};         ///< [m], true
  double radius{};        ///< [m]
  double ratio{};         ///< [-]
  double scale{1};        ///< [-], of Young's modulus
  double estimate{};      ///< [m]
  double low{};           ///< [m]
  double high{};          ///< [m]
  double stddev{};        ///< [m], as claimed
  double assumed_low{};   ///< [m], what the estimator takes for possible
  double assumed_high{};  ///< [m]
  double excluded{};      ///< [m], verdict None
  double hash{};          ///< [N]
  double bound{};         ///< [m], Cramer-Rao
  double signal{};        ///< [-], standard deviations
  double indentation{};   ///< [m], deepest
  std::uint32_t strokes{};
};

/// All cases of the study: how many, and one of them.
[[nodiscard]] std::uint32_t case_count(const DepthStudy& study);
[[nodiscard]] Result<DepthCase> run_case(const DepthStudy& study, std::uint32_t index);

/// Reports of the cases, sorted by index. `cases_csv`: where their rows are; empty: nowhere.
[[nodiscard]] std::string depth_report(const DepthStudy& study,
                                       const std::vector<DepthCase>& cases,
                                       const std::string& cases_csv);
[[nodiscard]] std::string depth_table(const DepthStudy& study, const std::vector<DepthCase>& cases);
[[nodiscard]] std::string depth_csv(const std::vector<DepthCase>& cases);

}  // namespace palp::lab
