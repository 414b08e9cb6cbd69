#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/core/result.h"
#include "study/psychometric.h"

/// Psychometric curves of free width, fitted as psignifit 4 does (Schutt et al. 2016): the whole
/// posterior on a grid, with overdispersion. For exploration and for comparison with other tools;
/// what a study measures comes from AnswerPosterior, which has one parameter less. Pure.
namespace palp::study {

enum class CurveShape : std::uint8_t { Normal, Logistic, Weibull };

[[nodiscard]] constexpr std::string_view to_string(CurveShape shape) noexcept {
  switch (shape) {
    case CurveShape::Normal:
      return "normal";
    case CurveShape::Logistic:
      return "logistic";
    case CurveShape::Weibull:
      return "weibull";
  }
  return "?";
}

/// psi(x) = guess + (1 - guess - lapse) F(x).
struct CurveParameters {
  double threshold{};   ///< [-], level where F is 0.5
  double width{};       ///< [-], > 0: from F = 0.05 to F = 0.95; Weibull: of ln level
  double lapse{};       ///< [-]
  double guess{};       ///< [-]
  double dispersion{};  ///< [-], 0 (binomial) to 1: share of the variance between sessions
};

/// F(level) [-]; Weibull: 0 at and below level 0.
[[nodiscard]] double curve_value(CurveShape shape,
                                 const CurveParameters& parameters,
                                 double level) noexcept;

/// Logarithm of the likelihood, beta-binomial where answers vary more than a coin's, without the
/// terms that no parameter changes.
[[nodiscard]] double log_likelihood(CurveShape shape,
                                    const CurveParameters& parameters,
                                    std::span<const Answers> answers) noexcept;

struct CurveFitOptions {
  CurveShape shape{CurveShape::Normal};
  int intervals{2};          ///< of a forced choice: guess is 1/intervals; 1: yes or no, guess free
  bool overdispersed{true};  ///< false: dispersion is 0
};

struct CurveEstimate {
  double likeliest{};  ///< [-], at the maximum of the joint posterior
  double mean{};       ///< [-]
  double low{};        ///< [-], 95 % interval of the marginal
  double high{};       ///< [-]
};

struct CurveFit {
  CurveEstimate threshold;
  CurveEstimate width;
  CurveEstimate lapse;
  CurveEstimate guess;
  CurveEstimate dispersion;
  double deviance{};  ///< [-], at the likeliest parameters, against one share for each level

  [[nodiscard]] CurveParameters likeliest() const noexcept {
    return {threshold.likeliest,
            width.likeliest,
            lapse.likeliest,
            guess.likeliest,
            dispersion.likeliest};
  }
};

/// `answers` pooled, of at least 2 levels. Priors as psignifit 4: threshold even over the levels
/// and falling to 0 half their range outside; width even from twice the least distance of two
/// levels to their range, falling to 0 at once and at three times; lapse, guess and dispersion
/// Beta(1, 10).
[[nodiscard]] Result<CurveFit> fit_curve(std::span<const Answers> answers,
                                         const CurveFitOptions& options);

}  // namespace palp::study
