// Goal: the posterior over the plane means what it says, and moves with what was touched. Method:
// touches of known balls through the noise of the sensor, given to the model they were made of.
#include "depth/map_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "depth/map_cells.h"
#include "depth/map_verdict.h"
#include "depth/next_touch.h"
#include "depth/seen_balls.h"

namespace palp::depth {
namespace {

constexpr double kNoise = 0.021;  // [N], the steps' share included

/// What is below the surface.
struct Truth {
  DepthDatabase::Query ball{.depth = 7e-3, .radius = 9e-3, .ratio = 100};
  Place axis{.x = 1.5e-3, .y = -2e-3};
  bool plain{};
  double scale{1};      ///< [-]
  double stiffening{};  ///< [-], of the force at 4 mm
  double kink{};        ///< [-], of the slope of the force, from 2 mm on
};

class MapTest : public testing::Test {
 protected:
  static const DepthDatabase& database() {
    static const DepthDatabase one = *default_database();
    return one;
  }
  static const BallField& field() {
    static const BallField one{database(), {}, lateral_share(database())};
    return one;
  }
  static const CurveBasis& basis() {
    static const CurveBasis one{database()};
    return one;
  }

  /// A slow stroke of 4 mm, without pole and steps.
  static PlaceData felt(const Truth& truth, const Place& place, std::uint64_t seed, double noise) {
    const RandomStream random{seed, 1};
    const auto plain = database().plain();
    const auto curve = truth.plain ? plain : database().curve(truth.ball);
    const double left =
        truth.plain ? 0 : lateral_share(database())(truth.ball, distance(place, truth.axis), 2e-3);
    const double surface = 0.2e-3 * random.normal(0);
    Touch touch;
    constexpr int kSamples = 400;
    for (int i = 0; i < kSamples; ++i) {
      const double d = -0.2e-3 + 4.2e-3 * i / kSamples;
      const double excess = d > 0 ? left * database().log_excess(curve, d) : 0;
      const double force =
          truth.scale * database().force(plain, d) * std::exp(excess) *
          (1 + truth.stiffening * d / 4e-3 + truth.kink * std::max(0.0, d - 2e-3) / 2e-3);
      touch.push_back({.tip = surface + d,
                       .force = force + noise * random.normal(static_cast<std::uint64_t>(i) + 1),
                       .span = 1e-3});
    }
    return *place_data({.place = place,
                        .touches = std::span{&touch, 1},
                        .surface = surface,
                        .noise = noise,
                        .stiffness = {.rate_factor = 0, .rate_factor_stddev = 1e-3}},
                       basis());
  }

  static std::vector<Place> pattern(int columns, int rows, double pitch) {
    std::vector<Place> out;
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        out.push_back({(i - 0.5 * (columns - 1)) * pitch, (j - 0.5 * (rows - 1)) * pitch});
      }
    }
    return out;
  }
  static std::vector<PlaceData> all_felt(const Truth& truth,
                                         const std::vector<Place>& places,
                                         std::uint64_t seed,
                                         double noise = kNoise) {
    std::vector<PlaceData> out;
    for (std::size_t i = 0; i < places.size(); ++i) {
      out.push_back(felt(truth, places[i], seed * 100 + i, noise));
    }
    return out;
  }
  static TissuePrior tissue(double spread) {
    return {.stiffness = {.rate_factor = 0, .rate_factor_stddev = 1e-3}, .place_spread = spread};
  }
  static MapLikelihood likelihood(std::vector<PlaceData> places, double spread = 0.01) {
    return {field(), tissue(spread), std::move(places)};
  }
  static MapPosterior posterior(std::vector<PlaceData> places, double spread = 0.01) {
    return map_posterior(likelihood(std::move(places), spread), field(), {});
  }
};

TEST_F(MapTest, ABallIsFoundWithItsPlaceDepthAndSize) {
  const Truth truth;
  const MapPosterior found = posterior(all_felt(truth, pattern(3, 3, 7.5e-3), 1));
  EXPECT_GT(found.log_evidence, 10);
  EXPECT_NEAR(found.x.median, truth.axis.x, 1e-3);
  EXPECT_NEAR(found.y.median, truth.axis.y, 1e-3);
  EXPECT_NEAR(found.depth.median, truth.ball.depth, 3 * found.depth.stddev);
  EXPECT_NEAR(found.radius.median, truth.ball.radius, 3 * found.radius.stddev);
  EXPECT_LT(found.depth.stddev, 1.5e-3);
  EXPECT_GT(found.balls_worth, 100);
}

bool doubts(const MapVerdict& verdict, MapDoubt doubt) {
  return std::ranges::find(verdict.doubts, doubt) != verdict.doubts.end();
}

TEST_F(MapTest, APosteriorOfHardlyAnyBallIsDoubted) {
  const MapLikelihood felt = likelihood(all_felt({}, pattern(3, 3, 7.5e-3), 1));
  MapPosterior found = map_posterior(felt, field(), {});
  EXPECT_FALSE(doubts(map_verdict(felt, found), MapDoubt::NotOneBall));
  found.balls_worth = 3;
  EXPECT_TRUE(doubts(map_verdict(felt, found), MapDoubt::NotOneBall));
}

TEST_F(MapTest, ACurveIsDoubtedByItsNoiseAndByItsForce) {
  const auto curve_doubted = [](double noises, double of_force) {
    std::vector<PlaceData> places = all_felt({}, pattern(3, 3, 7.5e-3), 1);
    PlaceData& one = places.front();
    one.force = 1e4 * one.samples;  // a hundred times the noise
    one.misfit =
        one.samples + noises * std::sqrt(2 * one.samples) + of_force * of_force * one.force;
    const MapLikelihood felt = likelihood(std::move(places));
    return doubts(map_verdict(felt, map_posterior(felt, field(), {})), MapDoubt::Curve);
  };
  EXPECT_FALSE(curve_doubted(10, 0));
  EXPECT_TRUE(curve_doubted(25, 0.02));
  EXPECT_FALSE(curve_doubted(10, 0.02)) << "2 % of the force are the curve's few terms";
  EXPECT_TRUE(curve_doubted(0, 0.5));
}

TEST_F(MapTest, SomeBallsStandForThePosterior) {
  const Truth truth;
  const MapPosterior found = posterior(all_felt(truth, pattern(3, 3, 7.5e-3), 1));
  const std::vector<SeenBall> balls = seen_balls(field(), found);
  ASSERT_EQ(balls.size(), 200U);
  double x = 0;
  for (const SeenBall& one : balls) {
    x += one.ball.place.x / static_cast<double>(balls.size());
    const Place beside{one.ball.place.x + 6e-3, one.ball.place.y};
    EXPECT_GT(one.log_ratio(one.ball.place), one.log_ratio(beside));
    EXPECT_GT(one.log_ratio(beside), 0);
  }
  EXPECT_NEAR(x, found.x.median, found.x.stddev);
}

/// Ranks of the truth in the posteriors are even, whatever was found.
TEST_F(MapTest, IntervalsHoldTheTruthAsOftenAsTheySay) {
  constexpr int kPhantoms = 60;
  std::array<int, kBallCoordinates> inside{};
  for (int i = 0; i < kPhantoms; ++i) {
    const RandomStream random{77, static_cast<std::uint64_t>(i)};
    Truth truth;
    truth.ball = {.depth = 3e-3 + 24e-3 * random.uniform(0),
                  .radius = 3e-3 + 13e-3 * random.uniform(1),
                  .ratio = 3 * std::pow(300, random.uniform(2))};
    truth.ball.depth = std::min(truth.ball.depth, 57e-3 - 2 * truth.ball.radius);
    const auto places = pattern(3, 3, 8e-3);
    // Anywhere below the discs, as the prior has it.
    const Place& near = places[static_cast<std::size_t>(9 * random.uniform(3))];
    truth.axis = {near.x + 15e-3 * (2 * random.uniform(4) - 1) / std::sqrt(2),
                  near.y + 15e-3 * (2 * random.uniform(5) - 1) / std::sqrt(2)};
    truth.scale = 1 + 0.1 * random.normal(6);
    const MapPosterior told =
        posterior(all_felt(truth, places, 1000 + static_cast<std::uint64_t>(i)), 0.003);
    const auto count = [&](std::size_t k, const Estimated& one, double value) {
      inside[k] += one.low <= value && value <= one.high ? 1 : 0;
    };
    count(0, told.x, truth.axis.x);
    count(1, told.y, truth.axis.y);
    count(2, told.depth, truth.ball.depth);
    count(3, told.radius, truth.ball.radius);
    count(4, told.ratio, truth.ball.ratio);
  }
  // 57 of 60 expected; fewer than 51 has a chance of 1 in 200.
  for (const int count : inside) EXPECT_GE(count, 51);
}

TEST_F(MapTest, TwoTopsOfThePosteriorSideBySideAreOnePlace) {
  const auto seen = likelihood(all_felt({}, pattern(3, 3, 7.5e-3), 1));
  MapPosterior found = map_posterior(seen, field(), {});
  const auto two_sides = [&](double apart) {
    found.modes = {{{}, 0.6}, {{apart, 0}, 0.4}};
    const auto doubts = map_verdict(seen, found).doubts;
    return std::find(doubts.begin(), doubts.end(), MapDoubt::TwoSides) != doubts.end();
  };
  EXPECT_FALSE(two_sides(2e-3));
  EXPECT_TRUE(two_sides(6e-3));
}

/// A large ball has more of the posterior than a small one that explains the touches as well.
TEST_F(MapTest, TheIntervalOfTheRadiusLeavesSmallBallsIn) {
  for (const double radius : {4e-3, 6e-3, 9e-3}) {
    const Truth truth{.ball = {.depth = 5e-3, .radius = radius, .ratio = 100}};
    const MapPosterior found = posterior(all_felt(truth, pattern(3, 3, 7.5e-3), 1), 0.05);
    double below = 0;
    double above = 0;
    for (const LikelyBall& one : found.balls) {
      if (one.ball.radius < found.radius.low) below += one.share;
      if (one.ball.radius > found.radius.high) above += one.share;
    }
    EXPECT_LE(below, 0.005);
    EXPECT_LE(above, 0.05);
    EXPECT_GT(below + above, 0);
  }
}

TEST_F(MapTest, TheOrderOfPlacesDoesNotMatter) {
  auto places = all_felt({}, pattern(3, 3, 7.5e-3), 2);
  const MapPosterior one = posterior(places);
  std::reverse(places.begin(), places.end());
  std::swap(places[1], places[5]);
  const MapPosterior other = posterior(places);
  EXPECT_EQ(one.x.median, other.x.median);
  EXPECT_EQ(one.depth.low, other.depth.low);
  EXPECT_EQ(one.log_evidence, other.log_evidence);
}

TEST_F(MapTest, TheAnswerMovesWithThePlaces) {
  auto places = all_felt({}, pattern(3, 3, 7.5e-3), 3);
  const MapPosterior here = posterior(places);
  for (PlaceData& one : places) {
    one.place.x += 31e-3;
    one.place.y -= 12e-3;
  }
  const MapPosterior there = posterior(places);
  EXPECT_NEAR(there.x.median - here.x.median, 31e-3, 0.1e-3);
  EXPECT_NEAR(there.y.median - here.y.median, -12e-3, 0.1e-3);
  EXPECT_NEAR(there.depth.median, here.depth.median, 0.1e-3);
  EXPECT_NEAR(there.log_evidence, here.log_evidence, 0.3);
}

TEST_F(MapTest, TheAnswerTurnsWithThePlaces) {
  auto places = all_felt({}, pattern(3, 3, 7.5e-3), 3);
  const MapPosterior before = posterior(places);
  for (PlaceData& one : places) one.place = {-one.place.y, one.place.x};
  const MapPosterior after = posterior(places);
  EXPECT_NEAR(after.x.median, -before.y.median, 0.15e-3);
  EXPECT_NEAR(after.y.median, before.x.median, 0.15e-3);
  EXPECT_NEAR(after.depth.median, before.depth.median, 0.2e-3);
}

/// Young's modulus, the noise and what is known of the modulus, a fifth more.
TEST_F(MapTest, StifferTissueChangesNothingElse) {
  const auto places = pattern(3, 3, 7.5e-3);
  Truth truth;
  const MapLikelihood soft = likelihood(all_felt(truth, places, 4));
  const MapPosterior before = map_posterior(soft, field(), {});
  truth.scale = 1.2;
  TissuePrior known = tissue(0.01);
  known.stiffness.scale = 1.2;
  known.stiffness.scale_stddev = 0.12;
  const MapLikelihood stiff{field(), known, all_felt(truth, places, 4, 1.2 * kNoise)};
  const MapPosterior after = map_posterior(stiff, field(), {});
  // The surfaces were sought with one prior, and so the balls drawn differ a little.
  EXPECT_NEAR(after.x.median, before.x.median, 0.1e-3);
  EXPECT_NEAR(after.depth.median, before.depth.median, 0.25 * before.depth.stddev);
  EXPECT_NEAR(after.depth.stddev, before.depth.stddev, 0.15 * before.depth.stddev);
  EXPECT_NEAR(stiff.rest(&before.best).scale, 1.2 * soft.rest(&before.best).scale, 0.01);
}

TEST_F(MapTest, TouchesAlongALineLeaveBothSidesOpen) {
  Truth truth;
  truth.axis = {1e-3, 6e-3};
  truth.ball.depth = 4e-3;
  const auto line = all_felt(truth, pattern(5, 1, 6e-3), 5);
  const MapLikelihood felt = likelihood(line);
  const MapPosterior told = map_posterior(felt, field(), {});
  EXPECT_LT(told.y.low, -3e-3);
  EXPECT_GT(told.y.high, 3e-3);
  EXPECT_NEAR(told.x.median, truth.axis.x, 1.5e-3);
  std::array<double, 2> sides{};
  for (const LikelyBall& one : told.balls) sides[one.ball.place.y > 0 ? 1 : 0] += one.share;
  EXPECT_GT(std::min(sides[0], sides[1]), 0.35);
  EXPECT_GE(told.modes.size(), 2U);
  const auto doubts = map_verdict(felt, told).doubts;
  EXPECT_NE(std::find(doubts.begin(), doubts.end(), MapDoubt::TwoSides), doubts.end());
}

TEST_F(MapTest, PlainTissueIsNoInclusionHoweverItsForceGrows) {
  for (const double stiffening : {0.0, 0.25}) {
    for (const double kink : {0.0, 0.2}) {
      Truth truth;
      truth.plain = true;
      truth.stiffening = stiffening;
      truth.kink = kink;
      const MapLikelihood felt = likelihood(all_felt(truth, pattern(3, 3, 7.5e-3), 6), 0.05);
      EXPECT_FALSE(map_verdict(felt, map_posterior(felt, field(), {})).found)
          << stiffening << ' ' << kink;
    }
  }
}

/// Tissue that varies by 5 % over 10 mm has bumps as broad as those above balls. Touches lie so
/// near one another that each is like its neighbours.
TEST_F(MapTest, ABumpOfUnevenTissueIsNoBall) {
  constexpr int kWaves = 40;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RandomStream random{seed, 6};
    Truth truth;
    truth.plain = true;
    std::vector<PlaceData> places;
    for (const Place& at : pattern(5, 5, 4e-3)) {
      double wave = 0;
      for (std::uint64_t i = 0; i < kWaves; ++i) {
        wave +=
            std::cos(random.normal(3 * i) * at.x / 10e-3 + random.normal(3 * i + 1) * at.y / 10e-3 +
                     2 * std::numbers::pi * random.uniform(3 * i + 2));
      }
      truth.scale = std::exp(0.05 * std::sqrt(2.0 / kWaves) * wave);
      places.push_back(felt(truth, at, 100 * seed + places.size(), kNoise));
    }
    const MapLikelihood told = likelihood(places, 0.05);
    found += map_verdict(told, map_posterior(told, field(), {})).found ? 1 : 0;
  }
  EXPECT_LE(found, 1);
}

TEST_F(MapTest, TheMapIsSurestWhereItWasTouched) {
  const auto places = all_felt({}, pattern(3, 3, 12e-3), 11);
  const MapLikelihood told = likelihood(places, 0.05);
  const auto rest = told.rest(nullptr);
  const double touched = told.told(rest, {places.front().place}).front().variance;
  const double beside = told.told(rest, {{6e-3, 6e-3}}).front().variance;
  const double far = told.told(rest, {{0.3, 0}}).front().variance;
  EXPECT_LT(touched, beside);
  EXPECT_LE(beside, far);
}

/// One place alone is stiffer than any ball makes it.
TEST_F(MapTest, AStifferSpotIsNotTrustedAsABall) {
  Truth truth;
  truth.plain = true;
  auto places = all_felt(truth, pattern(4, 4, 5e-3), 7);
  truth.scale = 1.5;
  places[5] = felt(truth, places[5].place, 9, kNoise);
  const MapLikelihood told = likelihood(places, 0.02);
  const MapVerdict verdict = map_verdict(told, map_posterior(told, field(), {}));
  EXPECT_NE(std::find(verdict.doubts.begin(), verdict.doubts.end(), MapDoubt::NotOneBall),
            verdict.doubts.end());
}

TEST_F(MapTest, OneMoreTouchNeverTellsLessThanNothingAndLessTheSecondTime) {
  const auto places = all_felt({}, pattern(2, 2, 8e-3), 8);
  const MapLikelihood told = likelihood(places);
  const MapPosterior balls = map_posterior(told, field(), {});
  const auto next = next_touch(told, field(), balls, 50e-3);
  ASSERT_TRUE(next);
  EXPECT_GT(next->gain, 0);
  for (const double x : {-20e-3, 0.0, 9e-3, 60e-3}) {
    EXPECT_GE(touch_gain(told, field(), balls, {x, 1e-3}), 0);
    EXPECT_LE(touch_gain(told, field(), balls, {x, 1e-3}), next->gain + 0.2);
  }
  auto more = places;
  more.push_back(felt({}, next->place, 9, kNoise));
  const MapLikelihood after = likelihood(more);
  EXPECT_LT(touch_gain(after, field(), map_posterior(after, field(), {}), next->place), next->gain);
}

/// Where no ball that may be reaches, a touch tells how stiff the tissue is and whether it varies,
/// and so which ball there is; when that is known it tells little.
TEST_F(MapTest, ATouchFarFromTheBallTellsOfItUntilTheTissueIsKnown) {
  auto places = all_felt({}, pattern(2, 3, 8e-3), 8);
  const Place far{60e-3, 60e-3};
  const auto gain = [&] {
    const MapLikelihood told = likelihood(places, 0.05);
    return touch_gain(told, field(), map_posterior(told, field(), {}), far);
  };
  const double before = gain();
  EXPECT_GT(before, 0.3);
  for (const double x : {-60e-3, -20e-3, 20e-3}) {
    places.push_back(felt({}, {x, 60e-3}, 9, kNoise));
    places.push_back(felt({}, {x, -60e-3}, 10, kNoise));
  }
  EXPECT_LT(gain(), 0.5 * before);
}

TEST_F(MapTest, NoTouchIsProposedWhereOneWasMade) {
  const auto places = all_felt({}, pattern(3, 3, 4e-3), 8);
  const MapLikelihood told = likelihood(places, 0.05);
  const MapPosterior balls = map_posterior(told, field(), {});
  for (const PlaceData& one : places) {
    EXPECT_EQ(touch_gain(told, field(), balls, one.place), 0);
  }
}

TEST_F(MapTest, WhereNoBallMayBeNoTouchTellsOfOne) {
  const MapLikelihood told = likelihood(all_felt({}, pattern(2, 2, 8e-3), 8), 0.05);
  MapPosterior none = map_posterior(told, field(), {});
  none.balls.clear();
  EXPECT_EQ(touch_gain(told, field(), none, {20e-3, 0}), 0);
}

/// How likely a guess of the tissue is follows from the touches, and the shares are all there is.
TEST_F(MapTest, EvenTissueIsLikelyWhereItWasEven) {
  const Truth truth;
  const MapLikelihood told = likelihood(all_felt(truth, pattern(5, 5, 8e-3), 8), 0.05);
  const MapBall ball{
      truth.axis, std::log(truth.ball.depth), truth.ball.radius, std::log(truth.ball.ratio)};
  const auto shares = told.guesses(ball);
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-9);
  EXPECT_GT(shares[0], 0.9) << "the guess of least spread";
}

/// The slopes that climbs and bounds are made of are those of the likelihood itself, but for the
/// tissue: they take it as first found, without a ball, and with one it is a tenth softer here.
TEST_F(MapTest, TheSlopeIsThatOfTheLikelihood) {
  const Truth truth;
  TissuePrior even = tissue(0);
  even.model_error = 0;
  const MapLikelihood told{field(), even, all_felt(truth, pattern(3, 3, 7.5e-3), 10)};
  MapBall ball{{truth.axis.x + 1e-3, truth.axis.y},
               std::log(truth.ball.depth) + 0.1,
               truth.ball.radius,
               std::log(truth.ball.ratio)};
  const auto local = told.around(ball);
  EXPECT_NEAR(local.value, told.at(ball), 1e-6);
  constexpr double kStep = 0.02e-3;
  MapBall low = ball;
  MapBall high = ball;
  low.place.x -= kStep;
  high.place.x += kStep;
  const double along_x = (told.at(high) - told.at(low)) / (2 * kStep);
  EXPECT_NEAR(local.slope[0], along_x, 0.2 * std::abs(along_x));
  low = high = ball;
  low.log_depth -= 2e-3;
  high.log_depth += 2e-3;
  const double along_depth = (told.at(high) - told.at(low)) / 4e-3;
  EXPECT_NEAR(local.slope[2], along_depth, 0.2 * std::abs(along_depth));
}

}  // namespace
}  // namespace palp::depth
