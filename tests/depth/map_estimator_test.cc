// Goal: strokes at several places become one answer, which follows the tissue and the stage.
// Method: taps of simulated blocks through sensor and tracker, as a site has them.
#include "depth/map_estimator.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "depth/stiffness_map.h"
#include "tests/depth/tapping.h"

namespace palp::depth {
namespace {

using patient::make_phantom;

/// One tap at each place.
class Palpation {
 public:
  explicit Palpation(const DepthEstimatorConfig& config = {}) : estimator_{config} {}

  void tap(const patient::Phantom& phantom, const Place& place, double indentation = 4e-3) {
    patient::SimulatedPhantomConfig config;
    config.seed = ++seed_;
    now_ = patient::feel_taps(phantom,
                              config,
                              {.taps = 1, .indentation = indentation, .place = place},
                              now_ + std::chrono::seconds{1},
                              [&](ContactSample sample) {
                                sample.session = session_;
                                if (estimator_.add(sample)) news_ = estimator_.map();
                              });
  }
  void raster(const patient::Phantom& phantom, double pitch) {
    for (int i = 0; i < 9; ++i) tap(phantom, {(i % 3 - 1) * pitch, (i / 3 - 1) * pitch});
  }
  void begin_session(std::uint64_t id) { session_ = id; }
  /// After the last stroke.
  [[nodiscard]] const std::optional<MapReport>& news() const { return news_; }
  [[nodiscard]] DepthEstimator& estimator() { return estimator_; }

 private:
  DepthEstimator estimator_;
  std::uint64_t seed_{};
  std::uint64_t session_{1};
  TimePoint now_{};
  std::optional<MapReport> news_;
};

TEST(MapEstimatorTest, NineTapsSayWhereHowDeepAndHowLarge) {
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=2,-3");
  ASSERT_TRUE(phantom);
  Palpation hand;
  hand.raster(*phantom, 10e-3);
  ASSERT_TRUE(hand.news());
  const MapReport& map = *hand.news();
  EXPECT_EQ(map.number, 9U);
  EXPECT_EQ(map.places, 9U);
  EXPECT_EQ(map.verdict, DepthVerdict::Found);
  EXPECT_TRUE(map.trusted());
  EXPECT_NEAR(map.x.median, 2e-3, 1e-3);
  EXPECT_NEAR(map.y.median, -3e-3, 1e-3);
  EXPECT_LT(map.depth.low, 5e-3);
  EXPECT_GT(map.depth.high, 5e-3);
  EXPECT_LT(map.radius.low, 12e-3);
  EXPECT_GT(map.radius.high, 12e-3);
  EXPECT_EQ(map.place_spread, MapEstimatorConfig{}.place_spread);
  EXPECT_FALSE(hand.estimator().map()) << "no stroke has come since";
}

TEST(MapEstimatorTest, TheMapIsStiffOverTheBallAndPlainFarFromIt) {
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=2,-3");
  Palpation hand;
  EXPECT_TRUE(hand.estimator().map_cells().empty());
  hand.raster(*phantom, 10e-3);
  const auto cells = hand.estimator().map_cells();
  ASSERT_EQ(cells.size(), kMapCellsMax);
  const auto cell_near = [&](const Place& place) {
    return *std::min_element(cells.begin(), cells.end(), [&](const MapCell& a, const MapCell& b) {
      return distance(a.place, place) < distance(b.place, place);
    });
  };
  const MapCell over = cell_near({2e-3, -3e-3});
  const MapCell beside = cell_near({-22e-3, 22e-3});
  EXPECT_EQ(over.number, 9U);
  EXPECT_GT(over.inclusion, 0.95);
  EXPECT_LT(beside.inclusion, 0.05);
  EXPECT_NEAR(over.stiffness, phantom->over.force(2.3e-3) / phantom->plain.force(2.3e-3), 0.1);
  EXPECT_NEAR(beside.stiffness, 1, 0.05);
  EXPECT_GT(over.stiffness_stddev, 0);
  EXPECT_LT(over.stiffness_stddev, 0.1);
}

TEST(MapEstimatorTest, PlainTissueIsNoInclusionAndTellsNoLengths) {
  const auto phantom = make_phantom("block e_kpa=17 varies=0.03");
  ASSERT_TRUE(phantom);
  Palpation hand;
  hand.raster(*phantom, 10e-3);
  ASSERT_TRUE(hand.news());
  EXPECT_EQ(hand.news()->verdict, DepthVerdict::None);
  EXPECT_EQ(hand.news()->x, Located{});
  EXPECT_EQ(hand.news()->depth, Located{});
}

/// Nobody said so: the estimator is told of 15.3 kPa.
TEST(MapEstimatorTest, StiffTissueIsNoInclusionBelowAllPlaces) {
  for (const char* words : {"block e_kpa=5", "block e_kpa=33", "block e_kpa=40"}) {
    const auto phantom = make_phantom(words);
    ASSERT_TRUE(phantom);
    for (const std::vector<Place>& places : std::vector<std::vector<Place>>{
             {{-7e-3, -4e-3}, {7e-3, -4e-3}, {0, 8e-3}},
             {{-10e-3, 0}, {0, 0}, {10e-3, 0}, {0, 10e-3}, {0, -10e-3}}}) {
      Palpation hand;
      for (const Place& place : places) hand.tap(*phantom, place);
      ASSERT_TRUE(hand.news());
      EXPECT_EQ(hand.news()->verdict, DepthVerdict::None) << words;
      EXPECT_TRUE(hand.news()->trusted()) << words;
    }
  }
}

TEST(MapEstimatorTest, ABallInStiffTissueIsFoundAsInAny) {
  const auto phantom = make_phantom("block e_kpa=40; ball depth=5 radius=12 ratio=300 at=2,-3");
  Palpation hand;
  hand.raster(*phantom, 10e-3);
  ASSERT_TRUE(hand.news());
  EXPECT_EQ(hand.news()->verdict, DepthVerdict::Found);
  EXPECT_TRUE(hand.news()->trusted());
  EXPECT_NEAR(hand.news()->x.median, 2e-3, 1e-3);
  EXPECT_NEAR(hand.news()->depth.median, 5e-3, 1e-3);
}

TEST(MapEstimatorTest, TwoPlacesAreLeftToTheEstimatorOfTheSinglePlace) {
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=0,0");
  Palpation hand;
  hand.tap(*phantom, {});
  hand.tap(*phantom, {20e-3, 0});
  hand.tap(*phantom, {20e-3, 0});
  EXPECT_FALSE(hand.news());
  hand.tap(*phantom, {10e-3, 10e-3});
  EXPECT_TRUE(hand.news());
}

TEST(MapEstimatorTest, AnotherSessionBeginsWithNothing) {
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=0,0");
  Palpation hand;
  hand.tap(*phantom, {});
  hand.tap(*phantom, {20e-3, 0});
  hand.begin_session(2);
  hand.tap(*phantom, {0, 10e-3});
  hand.tap(*phantom, {10e-3, 10e-3});
  EXPECT_FALSE(hand.news());
  hand.tap(*phantom, {10e-3, 0});
  ASSERT_TRUE(hand.news());
  EXPECT_EQ(hand.news()->places, 3U);
  EXPECT_EQ(hand.news()->number, 5U) << "strokes are counted on";
}

TEST(MapEstimatorTest, AShortStrokeIsNoTouch) {
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=0,0");
  Palpation hand;
  hand.tap(*phantom, {});
  hand.tap(*phantom, {10e-3, 0});
  hand.tap(*phantom, {0, 10e-3}, 1.2e-3);
  EXPECT_FALSE(hand.news());
}

TEST(MapEstimatorTest, NoTouchIsProposedBeyondTheStage) {
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=9,0");
  DepthEstimatorConfig config;
  const PatientDevices devices{.stage = {.travel_side = 6e-3}, .sensor = config.strokes.sensor};
  Palpation hand{with_devices(config, devices)};
  hand.raster(*phantom, 5e-3);
  ASSERT_TRUE(hand.news());
  EXPECT_LE(std::abs(hand.news()->next.x), 6e-3);
  EXPECT_LE(std::abs(hand.news()->next.y), 6e-3);
  EXPECT_GT(hand.news()->next_gain, 0);
}

TEST(MapEstimatorTest, OthersThanBayesForBallsHaveNoMap) {
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=0,0");
  DepthEstimatorConfig cylinders;
  cylinders.bayes.prior.shape = fem::InclusionShape::Cylinder;
  for (const DepthEstimatorConfig& config : {patient::paper_estimator(), cylinders}) {
    Palpation hand{config};
    for (const double x : {0.0, 10e-3, 20e-3}) hand.tap(*phantom, {x, 0});
    EXPECT_FALSE(hand.news());
  }
}

TEST(MapEstimatorTest, ItSaysWhenTheTapsAreEnough) {
  const auto phantom = make_phantom("ball depth=4 radius=12 ratio=300 at=1,1");
  const auto stop_at = [&](double known, double news) {
    DepthEstimatorConfig config;
    config.map.known = known;
    config.map.news = news;
    Palpation hand{config};
    hand.raster(*phantom, 10e-3);
    return hand.news().value().stop;
  };
  EXPECT_EQ(stop_at(2e-3, 0), MapStop::Known);
  EXPECT_EQ(stop_at(1e-5, 0), MapStop::GoOn);
  EXPECT_EQ(stop_at(1e-5, 100), MapStop::NoMoreNews);
}

}  // namespace
}  // namespace palp::depth
