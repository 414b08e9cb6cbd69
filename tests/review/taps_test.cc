#include "review/taps.h"

#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

using test::load;
using test::sample_session;

std::vector<Tap> taps_of(const test::SampleFiles& files) {
  const auto session = load(files);
  const auto tissue = judge::TissueTable::parse(*session.patient.texts.tissue_csv);
  const auto hand = test::hand_motion(static_cast<int>(session.surgeon.ticks / 2000));
  return match_taps(session.surgeon,
                    session.patient,
                    {},
                    test::find_excursions(hand, test::kSurface, &*tissue))
      .taps;
}

/// The same of a hand that moved so, where nobody knows the tissue.
std::vector<Tap> taps_of(const test::LoadedSession& session,
                         const std::vector<judge::Motion>& hand) {
  return match_taps(
             session.surgeon, session.patient, {}, test::find_excursions(hand, test::kSurface))
      .taps;
}

TEST(TapsTest, EachStrokeGetsItsPlaceIndexAndStiffness) {
  const auto taps = taps_of(sample_session());
  ASSERT_EQ(taps.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(taps[k].place, k < 3 ? kSiteA : kSiteB);
    EXPECT_EQ(taps[k].index, static_cast<int>(k % 3) + 1);
    EXPECT_EQ(taps[k].kind, StrokeKind::Tap);
    EXPECT_NEAR(taps[k].stiffness.felt().value(), k < 3 ? test::kFeltA : test::kFeltB, 1e-6);
    EXPECT_NEAR(taps[k].stiffness.truth().value(), k < 3 ? 100 : 200, 1e-6);
  }
}

TEST(TapsTest, StrokeThatThePatientNeverSawDoesNotShiftTheOthers) {
  // The hand of stroke 1 never became a stroke; make its force one that would be noticed.
  const auto files = sample_session({.unseen_stroke = 1});
  const auto session = load(files);
  auto hand = test::hand_motion(3);
  for (judge::Motion& motion : hand) {
    if (motion.at >= test::at_ms(1000) && motion.at < test::at_ms(2000)) {
      motion.force = 0;
    }
  }
  const auto taps = taps_of(session, hand);
  ASSERT_EQ(taps.size(), 5u);
  EXPECT_NEAR(taps[1].stiffness.felt().value(), test::kFeltA, 1e-6);
  EXPECT_EQ(taps[1].estimate.number, 3u);
}

TEST(TapsTest, ATouchThatNoEstimateCameOfStandsInItsTurn) {
  const auto session = load(sample_session({.unseen_stroke = 1}));
  const auto hand = test::hand_motion(3);
  const auto touches =
      match_taps(session.surgeon, session.patient, {}, test::find_excursions(hand, test::kSurface));
  EXPECT_EQ(touches.taps.size(), 5u);
  ASSERT_EQ(touches.others.size(), 1u);
  EXPECT_EQ(touches.others[0].place, kSiteA);
  EXPECT_GT(touches.others[0].contact_at, touches.taps[0].began_at);
  EXPECT_LT(touches.others[0].contact_at, touches.taps[1].began_at);
  const std::string text = tap_table(session.surgeon.began_at, touches, {}, {});
  EXPECT_LT(text.find("tap 1"), text.find("no estimate came of it"));
  EXPECT_LT(text.find("no estimate came of it"), text.find("tap 2"));
}

TEST(TapsTest, AStrokeBeginsWithTheHandsContact) {
  const auto session = load(sample_session());
  const auto hand = test::hand_motion(3);
  const auto touches =
      match_taps(session.surgeon, session.patient, {}, test::find_excursions(hand, test::kSurface));
  ASSERT_EQ(touches.taps.size(), 6u);
  std::size_t next = 0;
  double before = -1;
  for (const judge::Motion& tick : hand) {
    const double indentation = tick.position - test::kSurface;
    if (indentation > 0 && !(before > 0) && next < touches.taps.size()) {
      EXPECT_EQ(touches.taps[next++].began_at, tick.at);
    }
    before = indentation;
  }
  EXPECT_EQ(next, 6u);
}

TEST(TapsTest, ManyEstimatesOfOneLongStrokeTakeNoLonger) {
  // A file that nobody of ours wrote: with every pair compared this would take minutes.
  auto session = load(sample_session());
  std::vector<judge::Motion> hand(300'000);
  for (judge::Motion& motion : hand) {
    motion.position = test::kSurface + 2e-3;
    motion.velocity = 1;
  }
  session.surgeon.reports.resize(1);
  session.patient.estimates.resize(1);
  session.surgeon.reports.resize(50'000, session.surgeon.reports.front());
  session.patient.estimates.resize(50'000, session.patient.estimates.front());
  EXPECT_EQ(taps_of(session, hand).size(), 50'000u);
}

TEST(TapsTest, HandAtAnotherPlaceIsNotTheOneOfTheStroke) {
  const auto session = load(sample_session());
  auto hand = test::hand_motion(3);
  for (judge::Motion& motion : hand) {
    motion.place = kSiteB;
  }
  const auto taps = taps_of(session, hand);
  EXPECT_FALSE(taps[0].stiffness.felt()) << "A";
  EXPECT_TRUE(taps[3].stiffness.felt()) << "B";
}

TEST(TapsTest, WithoutItsReportAStrokeHasNoStiffness) {
  const auto taps = taps_of(sample_session({.reports = false}));
  ASSERT_EQ(taps.size(), 6u);
  for (const Tap& tap : taps) EXPECT_FALSE(tap.stiffness.felt());
}

TEST(TapsTest, LongStrokeIsAPress) {
  auto session = load(sample_session({.reports = false}));
  auto& estimates = session.patient.estimates;
  estimates[1].stroke_began_at = estimates[1].stroke_ended_at - kTapMax;
  estimates[2].stroke_began_at = estimates[2].stroke_ended_at - kTapMax - Duration{1};
  const auto taps = taps_of(session, test::hand_motion(3));
  EXPECT_EQ(taps[1].kind, StrokeKind::Tap);
  EXPECT_EQ(taps[2].kind, StrokeKind::Press);
  EXPECT_EQ(taps[2].index, 1);
}

TEST(TapsTest, AHandThatStaysInTheTissueMakesAPress) {
  const auto session = load(sample_session());
  auto hand = test::hand_motion(3);
  // The first stroke never leaves: the hand stays at the depth of its turning point for 2 s.
  for (judge::Motion& motion : hand) {
    if (motion.at >= test::at_ms(400) && motion.at < test::at_ms(2400)) {
      motion.position = test::kSurface + 4e-3;
    }
  }
  const auto taps = taps_of(session, hand);
  EXPECT_EQ(taps[0].kind, StrokeKind::Press);
}

TEST(TapsTest, TheTapsOverTheInclusionDecideTogether) {
  auto taps = taps_of(sample_session({.taps_per_place = 4}));
  ASSERT_EQ(taps.size(), 8u);
  EXPECT_EQ(overall_depth(taps)->verdict, DepthVerdict::Found);
  EXPECT_NEAR(overall_depth(taps)->depth.value(), 0.0098 + 1e-4 * 5.5, 1e-12);
  EXPECT_FALSE(overall_depth(taps)->low) << "this estimator gives no interval";
  for (std::size_t k = 4; k < 7; ++k) {
    taps[k].estimate.verdict = DepthVerdict::None;
    taps[k].estimate.depth_low = 0;  // nothing is excluded
  }
  EXPECT_EQ(overall_depth(taps)->verdict, DepthVerdict::None);
  EXPECT_FALSE(overall_depth(taps)->depth);
}

TEST(TapsTest, WithoutTapsOverTheInclusionThereIsNoVerdict) {
  auto taps = taps_of(sample_session());
  taps.resize(3);
  EXPECT_FALSE(overall_depth(taps));
  EXPECT_NE(tap_table({}, {}, overall_depth({}), {}).find("no stroke"), std::string::npos);
}

TEST(TapsTest, AMapSpeaksForAllPlaces) {
  const auto taps = taps_of(sample_session());
  const std::string text =
      tap_table({}, {taps, {}}, overall_depth(taps), {.number = 9, .places = 9});
  EXPECT_NE(text.find("all places together: No inclusion found"), std::string::npos);
  EXPECT_EQ(text.find("over the inclusion"), std::string::npos);
}

}  // namespace
}  // namespace palp::review
