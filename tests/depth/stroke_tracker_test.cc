#include "depth/stroke_tracker.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

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
    const auto strokes =
        strokes_of(*phantom, ideal_sensor(), {.taps = 4, .indentation = indentation});
    ASSERT_EQ(strokes.size(), 4U);
    EXPECT_NEAR(median_hash(strokes), expected, GetParam().tolerance * expected) << indentation;
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

TEST(StrokeTrackerTest, TellsTheDepthsApartWithTheRealSensor) {
  for (const Case& c : {Case{"paper-5mm", 0.04}, Case{"paper-10mm", 0.04}, Case{"none", 0.04}}) {
    const auto phantom = make_phantom(c.phantom);
    ASSERT_TRUE(phantom);
    const double expected = hash_of(phantom->over);
    const auto strokes = strokes_of(*phantom, {}, {.indentation = 3.8e-3});
    ASSERT_EQ(strokes.size(), 8U);
    EXPECT_NEAR(median_hash(strokes), expected, c.tolerance * expected) << c.phantom;
    EXPECT_NEAR(strokes.back().known.surface, 0, 0.1e-3);
    EXPECT_NEAR(strokes.back().indentation_max, 3.8e-3, 0.3e-3);
  }
}

TEST(StrokeTrackerTest, FindsAShiftedSurfaceAsWell) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  SimulatedPhantomConfig level = ideal_sensor();
  SimulatedPhantomConfig shifted = level;
  shifted.surface_offset = 1.7e-3;
  const auto here = strokes_of(*phantom, level, {.taps = 2});
  const auto there = strokes_of(*phantom, shifted, {.taps = 2});
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_NEAR(there[i].hash, here[i].hash, 0.002 * here[i].hash);
    EXPECT_NEAR(there[i].known.surface - here[i].known.surface, 1.7e-3, 5e-6);
  }
}

TEST(StrokeTrackerTest, AForceAtTheEndOfTheRangeIsInvalid) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  depth::StrokeTrackerConfig config;
  config.sensor.range = 0.3;
  const auto strokes = strokes_of(*phantom, ideal_sensor(), {.taps = 1}, config);
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_EQ(strokes[0].reason, DepthReason::ForceSaturated);
}

TEST(StrokeTrackerTest, TooFewSamplesAreInvalid) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  depth::StrokeTrackerConfig config;
  config.samples_min = 5000;
  const auto strokes = strokes_of(*phantom, ideal_sensor(), {.taps = 1}, config);
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_EQ(strokes[0].reason, DepthReason::StrokeTooFewSamples);
}

TEST(StrokeTrackerTest, ANoisyForceIsInvalidAndOneWithinTheLimitIsNot) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  SimulatedPhantomConfig sensor;
  sensor.force_noise = 0.15;
  const auto noisy = strokes_of(*phantom, sensor, {.taps = 1});
  ASSERT_FALSE(noisy.empty());
  EXPECT_EQ(noisy[0].reason, DepthReason::TooNoisy);
  sensor.force_noise = 0.04;
  const auto quieter = strokes_of(*phantom, sensor, {.taps = 1});
  ASSERT_FALSE(quieter.empty());
  EXPECT_NE(quieter[0].reason, DepthReason::TooNoisy);
}

TEST(StrokeTrackerTest, AStrokeThatGoesBackAndPressesOnIsNotMonotone) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  depth::StrokeTracker tracker{{}};
  SimulatedPhantomConfig sensor = ideal_sensor();
  sensor.start_position = -3e-3;
  SimulatedPhantom site{*phantom, sensor};
  std::vector<depth::Stroke> strokes;
  TimePoint now{};
  for (int i = 0; i < 3000; ++i) {
    now += std::chrono::milliseconds{1};
    const StageState stage = site.read(now);
    const auto stroke = tracker.take(
        {.at = now, .position = stage.position, .force = site.sample(now)->force, .place = {}});
    if (stroke) strokes.push_back(*stroke);
    // To 3 mm, back to 2 mm, on to 4 mm, out.
    const double t = i * 1e-3;
    const double target = t < 0.6   ? 10e-3 * t - 3e-3
                          : t < 0.8 ? 3e-3 - 5e-3 * (t - 0.6)
                          : t < 1.2 ? 2e-3 + 5e-3 * (t - 0.8)
                                    : 4e-3 - 10e-3 * (t - 1.2);
    site.move_to({std::max(-3e-3, target), {}});
  }
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[1].reason, DepthReason::StrokeNotMonotone);
}

TEST(StrokeTrackerTest, NothingIsSaidWithoutContact) {
  const auto phantom = make_phantom("none");
  ASSERT_TRUE(phantom);
  EXPECT_TRUE(strokes_of(*phantom, {}, {.taps = 3, .indentation = -0.5e-3}).empty());
}

TEST(StrokeTrackerTest, OtherTissueAtTheSamePlaceStartsAfresh) {
  // The tracker is not told that the phantom was exchanged; it must notice.
  const auto soft = make_phantom("none");
  const auto hard = make_phantom("paper-5mm");
  ASSERT_TRUE(soft && hard);
  depth::StrokeTracker tracker{{}};
  std::vector<double> hashes;
  TimePoint now{};
  for (const Phantom* phantom : {&*soft, &*hard}) {
    SimulatedPhantomConfig config = ideal_sensor();
    config.start_position = -3e-3;
    config.start_place = kSiteB;
    SimulatedPhantom site{*phantom, config};
    for (int i = 0; i < 2 * 1500; ++i) {
      now += std::chrono::milliseconds{1};
      const StageState stage = site.read(now);
      if (const auto stroke =
              tracker.take({now, stage.position, site.sample(now)->force, stage.place})) {
        hashes.push_back(stroke->hash);
      }
      const double t = std::min((i % 1500) * 1e-3, 1.0);
      site.move_to({-3e-3 + 3.4e-3 * (1 - std::cos(2 * std::numbers::pi * t)), kSiteB});
    }
  }
  ASSERT_EQ(hashes.size(), 4U);
  EXPECT_NEAR(hashes[1], hash_of(soft->over), 0.01 * hashes[1]);
  EXPECT_NEAR(hashes[3], hash_of(hard->over), 0.02 * hashes[3]);
}

TEST(StrokeTrackerTest, AHoldOnTheWayInIsStillOneStroke) {
  const auto phantom = make_phantom("paper-15mm");
  ASSERT_TRUE(phantom);
  SimulatedPhantomConfig config = ideal_sensor();
  config.start_position = -3e-3;
  config.start_place = kSiteB;
  SimulatedPhantom site{*phantom, config};
  depth::StrokeTracker tracker{{}};
  std::vector<depth::Stroke> strokes;
  TimePoint now{};
  for (int i = 0; i < 5500; ++i) {
    now += std::chrono::milliseconds{1};
    const StageState stage = site.read(now);
    if (const auto stroke =
            tracker.take({now, stage.position, site.sample(now)->force, stage.place})) {
      strokes.push_back(*stroke);
    }
    const double t = i * 1e-3;
    const double target = t < 2.5   ? std::min(-3e-3 + 10e-3 * t, 2e-3)
                          : t < 4.5 ? std::min(2e-3 + 8e-3 * (t - 2.5), 4e-3)
                                    : 4e-3 - 15e-3 * (t - 4.5);
    site.move_to({target, kSiteB});
  }
  ASSERT_EQ(strokes.size(), 1U);
  const double expected = hash_of(phantom->over);
  EXPECT_NEAR(strokes[0].hash, expected, 0.01 * expected);
}

TEST(StrokeTrackerTest, NumbersThatAreNoneAreIgnored) {
  depth::StrokeTracker tracker{{}};
  TimePoint now{};
  for (int i = 0; i < 100; ++i) {
    now += std::chrono::milliseconds{1};
    EXPECT_FALSE(tracker.take({now, std::nan(""), 0, 0}));
    EXPECT_FALSE(tracker.take({now, 0, std::nan(""), 0}));
  }
}

/// The touches of the place after a tap and another one's reversal. The samples of the first tap
/// after `cut` answers are lost on the way, if that is not 0, up to the next tap.
std::vector<depth::Touch> touches_of(const Tapping& tapping, std::size_t cut) {
  const auto phantom = plain_at_a("ball depth=9 radius=8 ratio=200");
  EXPECT_TRUE(phantom);
  depth::StrokeTracker tracker{{}};
  const TimePoint second{from_seconds(tapping.tap_time + tapping.rest_time)};
  std::size_t answers = 0;
  std::vector<depth::Touch> touches;
  feel_taps(*phantom, ideal_sensor(), tapping, {}, [&](const ContactSample& sample) {
    if (cut > 0 && answers == cut && sample.at < second) return;
    const auto stroke = tracker.take(sample);
    if (!stroke) return;
    ++answers;
    if (sample.at < second) return;
    ASSERT_EQ(stroke->reason, DepthReason::Ok);
    touches.assign(stroke->known.touches.begin(), stroke->known.touches.end());
  });
  return touches;
}

constexpr Tapping kTwice{.taps = 2, .indentation = 3.8e-3, .rest_time = 0.2};
constexpr Tapping kHesitantOnce{.taps = 2, .indentation = 3.8e-3, .rest_time = 0.2, .hesitant = 1};

double deepest(const depth::Touch& touch) {
  double most = touch.front().tip;
  for (const depth::TouchSample& sample : touch) most = std::max(most, sample.tip);
  return most;
}

TEST(StrokeTrackerTest, ATouchIsKeptToItsRelease) {
  const auto touches = touches_of(kTwice, 0);
  ASSERT_EQ(touches.size(), 2U);
  EXPECT_LT(touches.front().back().tip, 0.5e-3);
  EXPECT_GT(touches.back().back().tip, 3e-3);  // the second has only turned round
}

TEST(StrokeTrackerTest, AHesitantTouchIsKeptWholeToItsRelease) {
  const auto touches = touches_of(kHesitantOnce, 0);
  ASSERT_EQ(touches.size(), 2U);
  EXPECT_GT(deepest(touches.front()), 3.2e-3);
  EXPECT_LT(touches.front().back().tip, 0.5e-3);
}

/// What is lost after the second reversal takes nothing from what was felt before.
TEST(StrokeTrackerTest, AHesitantTouchIsKeptAsFarAsItCame) {
  const auto touches = touches_of(kHesitantOnce, 2);
  ASSERT_EQ(touches.size(), 2U);
  EXPECT_GT(deepest(touches.front()), 3.2e-3);
  EXPECT_GT(touches.front().back().tip, 2.5e-3);
}

TEST(StrokeTrackerTest, KeepsTheLastTouchesAlone) {
  const auto phantom = plain_at_a("ball depth=9 radius=8 ratio=200");
  ASSERT_TRUE(phantom);
  depth::StrokeTracker tracker{{}};
  Tapping tapping = kTwice;
  tapping.taps = 40;
  std::size_t strokes = 0;
  feel_taps(*phantom, ideal_sensor(), tapping, {}, [&](const ContactSample& sample) {
    const auto stroke = tracker.take(sample);
    if (!stroke) return;
    EXPECT_EQ(stroke->known.touched, ++strokes);
    EXPECT_EQ(stroke->known.touches.size(), std::min<std::size_t>(strokes, depth::kTouchesKept));
  });
  EXPECT_EQ(strokes, 40U);
}

TEST(StrokeTrackerTest, IndexesPlacesAndTheTissueUnderThem) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  depth::StrokeTracker tracker{{}};
  std::vector<depth::Stroke> strokes;
  TimePoint now{};
  for (const double x : {0.0, 20e-3, 0.4e-3}) {
    Tapping tapping = kTwice;
    tapping.place = {.x = x, .y = 0};
    now = feel_taps(*phantom, ideal_sensor(), tapping, now, [&](const ContactSample& sample) {
      if (const auto stroke = tracker.take(sample)) strokes.push_back(*stroke);
    });
  }
  ASSERT_EQ(strokes.size(), 6U);
  EXPECT_EQ(strokes[0].known.index, strokes[4].known.index);
  EXPECT_EQ(strokes[0].known.generation, strokes[4].known.generation);
  EXPECT_EQ(strokes[4].known.touched, 3U);
  EXPECT_EQ(strokes[4].known.place, kSiteA) << "a place stays where it was first touched";
  EXPECT_NE(strokes[0].known.index, strokes[2].known.index);
  EXPECT_NE(strokes[0].known.generation, strokes[2].known.generation);
  EXPECT_EQ(strokes[2].known.touched, 1U);
}

TEST(StrokeTrackerTest, TheOldestOfManyPlacesGivesWay) {
  const auto phantom = make_phantom("none");
  ASSERT_TRUE(phantom);
  depth::StrokeTracker tracker{{}};
  Tapping tapping{.taps = 1, .indentation = 3e-3, .tap_time = 0.5, .rest_time = 0.2};
  std::vector<depth::Stroke> strokes;
  TimePoint now{};
  for (std::size_t i = 0; i < depth::kPlacesMax + 2; ++i) {
    // The first place is touched again before there is one too many.
    tapping.place.x = i == depth::kPlacesMax ? 0 : static_cast<double>(i) * 5e-3;
    now = feel_taps(*phantom, ideal_sensor(), tapping, now, [&](const ContactSample& sample) {
      if (const auto stroke = tracker.take(sample)) strokes.push_back(*stroke);
    });
  }
  ASSERT_EQ(strokes.size(), depth::kPlacesMax + 2);
  EXPECT_EQ(strokes[depth::kPlacesMax].known.touched, 2U);
  EXPECT_EQ(strokes.back().known.index, strokes[1].known.index);
  EXPECT_EQ(strokes.back().known.touched, 1U);
  EXPECT_GT(strokes.back().known.generation, strokes[depth::kPlacesMax - 1].known.generation);
}

}  // namespace
}  // namespace palp::patient
