#include "judge/map_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::judge {
namespace {

using testing::HasSubstr;

std::string json_of(const MapReport& map) { return map_json(map).dump(); }

TEST(MapJsonTest, TooFewPlacesAreNull) { EXPECT_EQ(json_of({}), "null"); }

TEST(MapJsonTest, AnAnswerThatIsDoubtedIsNotTrustedWithReasonAndRemedy) {
  MapReport map{
      .number = 9, .places = 9, .verdict = DepthVerdict::Found, .depth = {7e-3, 6e-3, 8e-3}};
  EXPECT_THAT(json_of(map), HasSubstr(R"("verdict":"found")"));
  EXPECT_THAT(json_of(map), HasSubstr(R"("depth_low_mm":6.0)"));
  map.doubts = doubts_of(MapDoubt::TwoSides);
  EXPECT_THAT(json_of(map), HasSubstr(R"("verdict":"not_trusted")"));
  EXPECT_THAT(json_of(map), HasSubstr("touch beside the line of the touches"));
}

TEST(MapJsonTest, WhereNothingWasFoundThereAreNoLengths) {
  MapReport map{.number = 9, .places = 9, .verdict = DepthVerdict::None};
  EXPECT_THAT(json_of(map), HasSubstr(R"("depth_mm":null)"));
  EXPECT_THAT(json_of(map), HasSubstr(R"("verdict":"none")"));
  EXPECT_THAT(json_of(map), HasSubstr(R"("enough":false)"));
  map.stop = MapStop::NoMoreNews;
  EXPECT_THAT(json_of(map), HasSubstr(R"("enough":true)"));
}

}  // namespace
}  // namespace palp::judge
