#include "patient_site/estimator/paper_estimator.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "patient_site/estimator/cubic_fit.h"
#include "patient_site/estimator/paper_hash.h"
#include "tests/patient_site/tapping.h"

namespace palp::patient {
namespace {

double hash_of(const ForceTable& table) {
  std::vector<estimator::CurvePoint> points;
  for (int i = 0; i <= 80; ++i) points.push_back({i * 50e-6, table.force(i * 50e-6)});
  return estimator::hash(*estimator::fit_cubic(points));
}

double median_hash(const std::vector<DepthEstimate>& estimates) {
  std::vector<double> values;
  for (const DepthEstimate& estimate : estimates) values.push_back(estimate.hash);
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

struct Case {
  const char* phantom;
  double tolerance;  ///< share of h
};

// 0.5 % through stage, transducer and both filters; the table over the 5 mm inclusion ends at 4 mm
// and rises by steps of mesh error that move its surface by 5 um, 0.8 % of h.
class IdealTaps : public ::testing::TestWithParam<Case> {};

TEST_P(IdealTaps, GiveTheHashOfTheCurve) {
  const auto phantom = make_phantom(GetParam().phantom);
  ASSERT_TRUE(phantom);
  const double expected = hash_of(phantom->over);
  for (const double indentation : {3.3e-3, 3.9e-3}) {
    const auto estimates = tap(*phantom, ideal_sensor(), {.taps = 4, .indentation = indentation});
    ASSERT_EQ(estimates.size(), 4U);
    EXPECT_NEAR(median_hash(estimates), expected, GetParam().tolerance * expected) << indentation;
  }
}

INSTANTIATE_TEST_SUITE_P(SharedCurves,
                         IdealTaps,
                         ::testing::Values(Case{"none", 0.005},
                                           Case{"paper-25mm", 0.005},
                                           Case{"paper-20mm", 0.005},
                                           Case{"paper-15mm", 0.005},
                                           Case{"paper-10mm", 0.005},
                                           Case{"paper-5mm", 0.01}),
                         [](const auto& one) {
                           std::string name = one.param.phantom;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(PaperEstimatorTest, TellsTheDepthsApartWithTheRealSensor) {
  for (const Case& c : {Case{"paper-5mm", 0.04}, Case{"paper-10mm", 0.04}, Case{"none", 0.04}}) {
    const auto phantom = make_phantom(c.phantom);
    ASSERT_TRUE(phantom);
    const double expected = hash_of(phantom->over);
    const auto estimates = tap(*phantom, {}, {.indentation = 3.8e-3});
    ASSERT_EQ(estimates.size(), 8U);
    EXPECT_NEAR(median_hash(estimates), expected, c.tolerance * expected) << c.phantom;
    EXPECT_NEAR(estimates.back().surface, 0, 0.1e-3);
    EXPECT_NEAR(estimates.back().indentation_max, 3.8e-3, 0.3e-3);
  }
}

TEST(PaperEstimatorTest, FindsAShiftedSurfaceAsWell) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  SimulatedPhantomConfig level = ideal_sensor();
  SimulatedPhantomConfig shifted = level;
  shifted.surface_offset = 1.7e-3;
  const auto here = tap(*phantom, level, {.taps = 2});
  const auto there = tap(*phantom, shifted, {.taps = 2});
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_NEAR(there[i].hash, here[i].hash, 0.002 * here[i].hash);
    EXPECT_NEAR(there[i].surface - here[i].surface, 1.7e-3, 5e-6);
  }
}

TEST(PaperEstimatorTest, TissueOfAnotherStiffnessIsMeasuredToo) {
  for (const double factor : {0.5, 3.0}) {
    auto phantom = make_phantom("none");
    ASSERT_TRUE(phantom);
    std::vector<ForceRow> rows{phantom->over.rows().begin(), phantom->over.rows().end()};
    for (ForceRow& row : rows) row.force *= factor;
    phantom->over = *ForceTable::make(rows);
    const double expected = hash_of(phantom->over);
    const auto estimates = tap(*phantom, ideal_sensor(), {.taps = 4});
    ASSERT_EQ(estimates.size(), 4U);
    EXPECT_NEAR(median_hash(estimates), expected, 0.02 * expected);
    EXPECT_EQ(estimates.back().verdict, factor < 1 ? DepthVerdict::None : DepthVerdict::Invalid);
  }
}

TEST(PaperEstimatorTest, AShortStrokeIsInvalidAndStillGivesItsHash) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  const auto shallow = tap(*phantom, ideal_sensor(), {.taps = 1, .indentation = 2.2e-3});
  ASSERT_EQ(shallow.size(), 1U);
  EXPECT_EQ(shallow[0].verdict, DepthVerdict::Invalid);
  EXPECT_EQ(shallow[0].reason, DepthReason::StrokeTooShort);
  EXPECT_GT(shallow[0].hash, 0.05);
  const auto deep = tap(*phantom, ideal_sensor(), {.taps = 1, .indentation = 2.8e-3});
  ASSERT_EQ(deep.size(), 1U);
  EXPECT_EQ(deep[0].verdict, DepthVerdict::Found);
}

TEST(PaperEstimatorTest, AForceAtTheEndOfTheRangeIsInvalid) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  estimator::PaperEstimatorConfig config;
  config.sensor.range = 0.3;
  const auto estimates = tap(*phantom, ideal_sensor(), {.taps = 1}, config);
  ASSERT_EQ(estimates.size(), 1U);
  EXPECT_EQ(estimates[0].reason, DepthReason::ForceSaturated);
}

TEST(PaperEstimatorTest, TooFewSamplesAreInvalid) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  estimator::PaperEstimatorConfig config;
  config.samples_min = 5000;
  const auto estimates = tap(*phantom, ideal_sensor(), {.taps = 1}, config);
  ASSERT_EQ(estimates.size(), 1U);
  EXPECT_EQ(estimates[0].reason, DepthReason::StrokeTooFewSamples);
}

TEST(PaperEstimatorTest, ANoisyForceIsInvalidAndOneWithinTheLimitIsNot) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  SimulatedPhantomConfig sensor;
  sensor.force_noise = 0.15;
  const auto noisy = tap(*phantom, sensor, {.taps = 1});
  ASSERT_FALSE(noisy.empty());
  EXPECT_EQ(noisy[0].verdict, DepthVerdict::Invalid);
  EXPECT_EQ(noisy[0].reason, DepthReason::TooNoisy);
  sensor.force_noise = 0.04;
  const auto quieter = tap(*phantom, sensor, {.taps = 1});
  ASSERT_FALSE(quieter.empty());
  EXPECT_NE(quieter[0].reason, DepthReason::TooNoisy);
}

TEST(PaperEstimatorTest, AStrokeThatGoesBackAndPressesOnIsNotMonotone) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  estimator::PaperEstimator estimator{{}};
  SimulatedPhantomConfig sensor = ideal_sensor();
  sensor.start_position = -3e-3;
  SimulatedPhantom site{*phantom, sensor};
  std::vector<DepthEstimate> estimates;
  TimePoint now{};
  for (int i = 0; i < 3000; ++i) {
    now += std::chrono::milliseconds{1};
    const StageState stage = site.read(now);
    const auto estimate = estimator.add(
        {.at = now, .position = stage.position, .force = site.sample(now)->force, .lateral = 0});
    if (estimate) estimates.push_back(*estimate);
    // To 3 mm, back to 2 mm, on to 4 mm, out.
    const double t = i * 1e-3;
    const double target = t < 0.6   ? 10e-3 * t - 3e-3
                          : t < 0.8 ? 3e-3 - 5e-3 * (t - 0.6)
                          : t < 1.2 ? 2e-3 + 5e-3 * (t - 0.8)
                                    : 4e-3 - 10e-3 * (t - 1.2);
    site.move_to({std::max(-3e-3, target), 0});
  }
  ASSERT_EQ(estimates.size(), 2U);
  EXPECT_EQ(estimates[1].verdict, DepthVerdict::Invalid);
  EXPECT_EQ(estimates[1].reason, DepthReason::StrokeNotMonotone);
}

TEST(PaperEstimatorTest, NothingIsSaidWithoutContact) {
  const auto phantom = make_phantom("none");
  ASSERT_TRUE(phantom);
  EXPECT_TRUE(tap(*phantom, {}, {.taps = 3, .indentation = -0.5e-3}).empty());
}

TEST(PaperEstimatorTest, OtherTissueAtTheSamePlaceStartsAfresh) {
  // The estimator is not told that the phantom was exchanged; it must notice.
  const auto soft = make_phantom("none");
  const auto hard = make_phantom("paper-5mm");
  ASSERT_TRUE(soft && hard);
  estimator::PaperEstimator estimator{{}};
  std::vector<double> hashes;
  TimePoint now{};
  for (const Phantom* phantom : {&*soft, &*hard}) {
    SimulatedPhantomConfig config = ideal_sensor();
    config.start_position = -3e-3;
    config.start_lateral = 10e-3;
    SimulatedPhantom site{*phantom, config};
    for (int i = 0; i < 2 * 1500; ++i) {
      now += std::chrono::milliseconds{1};
      const StageState stage = site.read(now);
      if (const auto estimate =
              estimator.add({now, stage.position, site.sample(now)->force, stage.lateral})) {
        hashes.push_back(estimate->hash);
      }
      const double t = std::min((i % 1500) * 1e-3, 1.0);
      site.move_to({-3e-3 + 3.4e-3 * (1 - std::cos(2 * std::numbers::pi * t)), 10e-3});
    }
  }
  ASSERT_EQ(hashes.size(), 4U);
  EXPECT_NEAR(hashes[1], hash_of(soft->over), 0.01 * hashes[1]);
  EXPECT_NEAR(hashes[3], hash_of(hard->over), 0.02 * hashes[3]);
}

TEST(PaperEstimatorTest, AHoldOnTheWayInIsStillOneStroke) {
  const auto phantom = make_phantom("paper-15mm");
  ASSERT_TRUE(phantom);
  SimulatedPhantomConfig config = ideal_sensor();
  config.start_position = -3e-3;
  config.start_lateral = 10e-3;
  SimulatedPhantom site{*phantom, config};
  estimator::PaperEstimator estimator{{}};
  std::vector<DepthEstimate> estimates;
  TimePoint now{};
  for (int i = 0; i < 5500; ++i) {
    now += std::chrono::milliseconds{1};
    const StageState stage = site.read(now);
    if (const auto estimate =
            estimator.add({now, stage.position, site.sample(now)->force, stage.lateral})) {
      estimates.push_back(*estimate);
    }
    const double t = i * 1e-3;
    const double target = t < 2.5   ? std::min(-3e-3 + 10e-3 * t, 2e-3)
                          : t < 4.5 ? std::min(2e-3 + 8e-3 * (t - 2.5), 4e-3)
                                    : 4e-3 - 15e-3 * (t - 4.5);
    site.move_to({target, 10e-3});
  }
  ASSERT_EQ(estimates.size(), 1U);
  const double expected = hash_of(phantom->over);
  EXPECT_NEAR(estimates[0].hash, expected, 0.01 * expected);
}

TEST(PaperEstimatorTest, NumbersThatAreNoneAreIgnored) {
  estimator::PaperEstimator estimator{{}};
  TimePoint now{};
  for (int i = 0; i < 100; ++i) {
    now += std::chrono::milliseconds{1};
    EXPECT_FALSE(estimator.add({now, std::nan(""), 0, 0}));
    EXPECT_FALSE(estimator.add({now, 0, std::nan(""), 0}));
  }
}

/// The touches of the place after a tap and another one's reversal. The samples of the first tap
/// after `cut` answers are lost on the way, if that is not 0, up to the next tap.
std::vector<estimator::Touch> touches_of(const Tapping& tapping, std::size_t cut) {
  const auto phantom = make_phantom("ball depth=9 radius=8 ratio=200");
  EXPECT_TRUE(phantom);
  estimator::PaperEstimator estimator{{}};
  const TimePoint second{from_seconds(tapping.tap_time + tapping.rest_time)};
  std::size_t answers = 0;
  std::vector<estimator::Touch> touches;
  feel_taps(*phantom, ideal_sensor(), tapping, {}, [&](const ContactSample& sample) {
    if (cut > 0 && answers == cut && sample.at < second) return;
    if (!estimator.add(sample)) return;
    ++answers;
    if (sample.at < second) return;
    const auto place = estimator.place();
    ASSERT_TRUE(place);
    touches.assign(place->touches.begin(), place->touches.end());
  });
  return touches;
}

constexpr Tapping kTwice{.taps = 2, .indentation = 3.8e-3, .rest_time = 0.2};
constexpr Tapping kHesitantOnce{.taps = 2, .indentation = 3.8e-3, .rest_time = 0.2, .hesitant = 1};

double deepest(const estimator::Touch& touch) {
  double most = touch.front().tip;
  for (const estimator::TouchSample& sample : touch) most = std::max(most, sample.tip);
  return most;
}

TEST(PaperEstimatorTest, ATouchIsKeptToItsRelease) {
  const auto touches = touches_of(kTwice, 0);
  ASSERT_EQ(touches.size(), 2U);
  EXPECT_LT(touches.front().back().tip, 0.5e-3);
  EXPECT_GT(touches.back().back().tip, 3e-3);  // the second has only turned round
}

TEST(PaperEstimatorTest, AHesitantTouchIsKeptWholeToItsRelease) {
  const auto touches = touches_of(kHesitantOnce, 0);
  ASSERT_EQ(touches.size(), 2U);
  EXPECT_GT(deepest(touches.front()), 3.2e-3);
  EXPECT_LT(touches.front().back().tip, 0.5e-3);
}

/// What is lost after the second reversal takes nothing from what was felt before.
TEST(PaperEstimatorTest, AHesitantTouchIsKeptAsFarAsItCame) {
  const auto touches = touches_of(kHesitantOnce, 2);
  ASSERT_EQ(touches.size(), 2U);
  EXPECT_GT(deepest(touches.front()), 3.2e-3);
  EXPECT_GT(touches.front().back().tip, 2.5e-3);
}

TEST(PaperEstimatorTest, KeepsTheLastTouchesAlone) {
  const auto phantom = make_phantom("ball depth=9 radius=8 ratio=200");
  ASSERT_TRUE(phantom);
  estimator::PaperEstimator estimator{{}};
  Tapping tapping = kTwice;
  tapping.taps = 40;
  std::size_t strokes = 0;
  feel_taps(*phantom, ideal_sensor(), tapping, {}, [&](const ContactSample& sample) {
    if (!estimator.add(sample)) return;
    const auto place = estimator.place();
    ASSERT_TRUE(place);
    EXPECT_EQ(place->touched, ++strokes);
    EXPECT_EQ(place->touches.size(),
              std::min<std::size_t>(strokes, estimator::PaperEstimator::kTouchesKept));
  });
  EXPECT_EQ(strokes, 40U);
}

}  // namespace
}  // namespace palp::patient
