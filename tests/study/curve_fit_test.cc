#include "study/curve_fit.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr std::array kShapes{CurveShape::Normal, CurveShape::Logistic, CurveShape::Weibull};

std::vector<Answers> drawn(CurveShape shape,
                           const CurveParameters& truth,
                           std::size_t trials,
                           std::uint64_t stream) {
  std::vector<Answers> out;
  for (const double level : even_levels(0.03, 0.9, 7)) {
    Answers at{level, 0, trials};
    const double share =
        truth.guess + (1 - truth.guess - truth.lapse) * curve_value(shape, truth, level);
    for (std::size_t i = 0; i < trials; ++i) {
      at.yes += random_uniform(11, stream, out.size() * trials + i) < share ? 1U : 0U;
    }
    out.push_back(at);
  }
  return out;
}

TEST(CurveFitTest, WidthRunsFromFiveToNinetyFivePerCent) {
  for (const CurveShape shape : {CurveShape::Normal, CurveShape::Logistic}) {
    const CurveParameters p{.threshold = 0.2, .width = 0.1};
    EXPECT_NEAR(curve_value(shape, p, 0.2), 0.5, 1e-9) << to_string(shape);
    const double up = curve_value(shape, p, 0.25);
    EXPECT_NEAR(up, 0.95, 1e-9) << to_string(shape);
    EXPECT_NEAR(curve_value(shape, p, 0.15), 0.05, 1e-9) << to_string(shape);
  }
  const CurveParameters p{.threshold = 0.2, .width = 1.2};
  EXPECT_NEAR(curve_value(CurveShape::Weibull, p, 0.2), 0.5, 1e-9);
  // Not even around its middle, but 1.2 of ln level wide.
  double low = 0.01;
  double high = 0.01;
  while (curve_value(CurveShape::Weibull, p, low) < 0.05) low *= 1.0001;
  while (curve_value(CurveShape::Weibull, p, high) < 0.95) high *= 1.0001;
  EXPECT_NEAR(std::log(high / low), 1.2, 1e-3);
}

TEST(CurveFitTest, ManyAnswersGiveTheTruth) {
  for (const CurveShape shape : kShapes) {
    const CurveParameters truth{.threshold = 0.2,
                                .width = shape == CurveShape::Weibull ? 1.8 : 0.35,
                                .lapse = 0.03,
                                .guess = 0.5};
    const auto fit =
        fit_curve(drawn(shape, truth, 20000, 1), {.shape = shape, .overdispersed = false});
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->threshold.likeliest, 0.2, 0.006) << to_string(shape);
    EXPECT_NEAR(fit->width.likeliest / truth.width, 1, 0.06) << to_string(shape);
    EXPECT_NEAR(fit->lapse.likeliest, 0.03, 0.01) << to_string(shape);
    EXPECT_LT(fit->deviance, 25) << to_string(shape);
  }
}

// Four standard errors of the count.
TEST(CurveFitTest, IntervalsHoldTheTruth) {
  constexpr int kRuns = 120;
  int held = 0;
  const CurveParameters truth{.threshold = 0.25, .width = 0.4, .lapse = 0.02, .guess = 0.5};
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const auto fit =
        fit_curve(drawn(CurveShape::Normal, truth, 30, 100 + run), {.overdispersed = false});
    held += fit->threshold.low <= 0.25 && 0.25 <= fit->threshold.high ? 1 : 0;
  }
  EXPECT_GT(held / double{kRuns}, 0.95 - 4 * std::sqrt(0.95 * 0.05 / kRuns));
}

TEST(CurveFitTest, WithoutSpreadTheBetaBinomialIsTheBinomial) {
  const std::array<Answers, 3> answers{{{0.1, 12, 20}, {0.2, 15, 20}, {0.4, 19, 20}}};
  CurveParameters p{.threshold = 0.2, .width = 0.3, .lapse = 0.02, .guess = 0.5};
  const double binomial = log_likelihood(CurveShape::Normal, p, answers);
  p.dispersion = 1e-3;
  EXPECT_NEAR(log_likelihood(CurveShape::Normal, p, answers), binomial, 1e-4);
}

// Sessions whose shares vary more than a coin's widen the intervals.
TEST(CurveFitTest, VaryingSessionsWidenTheInterval) {
  std::vector<Answers> answers;
  for (std::size_t session = 0; session < 12; ++session) {
    const double share = random_uniform(2, 2, session) < 0.5 ? 0.6 : 0.9;
    answers.push_back(
        {0.1 + 0.02 * static_cast<double>(session), static_cast<std::size_t>(share * 40), 40});
  }
  const auto even = fit_curve(answers, {.overdispersed = false});
  const auto varied = fit_curve(answers, {.overdispersed = true});
  EXPECT_GT(varied->threshold.high - varied->threshold.low,
            1.3 * (even->threshold.high - even->threshold.low));
  EXPECT_GT(varied->dispersion.likeliest, 0.1);
}

TEST(CurveFitTest, AScaleOfTheLevelsScalesTheFit) {
  const CurveParameters truth{.threshold = 0.2, .width = 0.35, .lapse = 0.02, .guess = 0.5};
  auto answers = drawn(CurveShape::Logistic, truth, 60, 9);
  const auto one = fit_curve(answers, {.shape = CurveShape::Logistic, .overdispersed = false});
  for (Answers& at : answers) at.level *= 7;
  const auto other = fit_curve(answers, {.shape = CurveShape::Logistic, .overdispersed = false});
  EXPECT_NEAR(other->threshold.likeliest, 7 * one->threshold.likeliest, 1e-5);
  EXPECT_NEAR(other->threshold.low, 7 * one->threshold.low, 1e-6);
  EXPECT_NEAR(other->width.mean, 7 * one->width.mean, 1e-6);
}

TEST(CurveFitTest, RefusesWhatNoCurveFits) {
  EXPECT_FALSE(fit_curve(std::array<Answers, 1>{{{0.1, 3, 4}}}, {}));
  EXPECT_FALSE(fit_curve(std::array<Answers, 2>{{{-0.1, 3, 4}, {0.2, 4, 4}}},
                         {.shape = CurveShape::Weibull}));
}

}  // namespace
}  // namespace palp::study
