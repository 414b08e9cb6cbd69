#include "relay/relay_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palp::relay {
namespace {

TEST(RelayReportTest, SaysWhatWasDone) {
  RoomCounts counts;
  counts.forwarded = 7;
  counts.forged = 2;
  const auto json = nlohmann::json::parse(to_json(counts, std::chrono::milliseconds{1500}));
  EXPECT_EQ(json["schema"], "palp.rooms/1");
  EXPECT_EQ(json["forwarded"], 7);
  EXPECT_EQ(json["forged"], 2);
  EXPECT_EQ(json["duration_s"], 1.5);
  EXPECT_THAT(status_line(Rooms{}), testing::HasSubstr("0 rooms, 0 datagrams forwarded"));
}

}  // namespace
}  // namespace palp::relay
