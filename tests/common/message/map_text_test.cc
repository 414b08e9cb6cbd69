#include "common/message/map_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

MapReport found() {
  return {.number = 9,
          .places = 9,
          .verdict = DepthVerdict::Found,
          .x = {20.1e-3, 19.5e-3, 20.7e-3},
          .y = {0.3e-3, -0.4e-3, 1e-3},
          .depth = {9.8e-3, 9.1e-3, 10.6e-3},
          .radius = {14.9e-3, 13e-3, 16e-3},
          .place_spread = 0.05,
          .next = {24e-3, -4e-3},
          .next_gain = 0.2};
}

TEST(MapTextTest, ASentenceSaysPlaceDepthAndSizeAndWhatIsAssumed) {
  EXPECT_EQ(map_sentence(found()),
            "One round inclusion, if the tissue's stiffness varies by 5 % from place to place at "
            "most: at x 20.1 mm (19.5 to 20.7), y 0.3 mm (-0.4 to 1.0), its top 9.8 mm deep (9.1 "
            "to 10.6), radius 14.9 mm (13.0 to 16.0). The next tap tells most at 24,-4 mm.");
}

TEST(MapTextTest, DoubtsComeWithAReasonAndARemedy) {
  MapReport doubted = found();
  for (std::size_t i = 0; i < kMapDoubts; ++i) {
    const auto one = static_cast<MapDoubt>(i);
    doubted.doubts = doubts_of(one);
    EXPECT_THAT(map_sentence(doubted),
                AllOf(HasSubstr("Not trusted: " + std::string{reason_of(one)} + "; " +
                                std::string{remedy_of(one)} + ".")));
    EXPECT_THAT(map_line(doubted), HasSubstr("NOT TRUSTED"));
    EXPECT_THAT(map_brief(doubted), EndsWith("?"));
  }
  doubted.doubts = 1U << 31U;  // of a later version
  EXPECT_THAT(map_sentence(doubted), Not(HasSubstr("Not trusted: ")));
}

TEST(MapTextTest, EnoughTapsAreSaidSo) {
  MapReport enough = found();
  enough.stop = MapStop::Known;
  EXPECT_THAT(map_sentence(enough), EndsWith("Enough taps: place and depth are known."));
  enough.stop = MapStop::NoMoreNews;
  EXPECT_THAT(map_sentence(enough), HasSubstr("no further tap"));
  EXPECT_THAT(map_line(enough), EndsWith(", enough"));
}

TEST(MapTextTest, NothingFoundNamesNoLength) {
  const MapReport none{.number = 4, .places = 4, .verdict = DepthVerdict::None};
  EXPECT_THAT(map_sentence(none), AllOf(HasSubstr("No inclusion found"), Not(HasSubstr("radius"))));
  EXPECT_EQ(map_brief(none), "no inclusion");
  EXPECT_THAT(map_sentence({}), HasSubstr("three places"));
}

}  // namespace
}  // namespace palp
