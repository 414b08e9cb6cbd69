#include "monitor/status_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/json.h"
#include "common/record/notes.h"

namespace palp::monitor {
namespace {

using config::Json;

TEST(StatusJsonTest, SaysTheSessionInUnitsOfPeople) {
  LiveStatus status;
  status.tick.state = SiteState::Hold;
  status.tick.position = 0.0045;
  status.tick.force = 0.75;
  status.peer_position = -0.002;
  status.heard.round_trip = std::chrono::milliseconds{75};
  status.reason = static_cast<std::uint16_t>(record::NoteCode::GapHold);
  status.tick.short_by = 0.25;
  status.tick.short_note = static_cast<std::uint16_t>(record::NoteCode::TipFeelsMore);
  Pilot pilot;
  ASSERT_TRUE(pilot.take(3, "<script>"));
  const Json json = Json::parse(status_json(status, pilot, 2));
  EXPECT_EQ(json["state"].text(), "HOLD");
  EXPECT_EQ(json["reason"].text(), record::to_string(record::NoteCode::GapHold));
  EXPECT_EQ(json["refused"].text(), "");
  EXPECT_EQ(json["position_mm"].number(), 4.5);
  EXPECT_EQ(json["force_n"].number(), 0.75);
  EXPECT_EQ(json["peer_position_mm"].number(), -2);
  EXPECT_EQ(json["round_trip_ms"].number(), 75);
  EXPECT_EQ(json["force_short"].text(), record::to_string(record::NoteCode::TipFeelsMore));
  EXPECT_EQ(json["force_short_n"].number(), 0.25);
  EXPECT_EQ(json["pilot"].number(), 3);
  EXPECT_EQ(json["pilot_name"].text(), "<script>") << "text; the page makes no markup of it";
}

TEST(StatusJsonTest, TheSchemaNamesEveryMember) {
  const Json schema = Json::parse(status_schema());
  const Json status = Json::parse(status_json({}, {}, 0));
  EXPECT_EQ(schema["properties"].names().size(), status.names().size());
  EXPECT_EQ(schema["properties"]["force_n"]["type"].text(), "number");
  EXPECT_EQ(schema["properties"]["state"]["type"].text(), "string");
  EXPECT_EQ(schema["properties"]["recording"]["type"].text(), "boolean");
}

TEST(StatusJsonTest, AClientIsToldItsWay) {
  EXPECT_EQ(client_json(std::chrono::milliseconds{30}), R"({"round_trip_ms":30.0})");
  const Json schema = Json::parse(client_schema());
  EXPECT_EQ(schema["properties"]["round_trip_ms"]["type"].text(), "number");
}

}  // namespace
}  // namespace palp::monitor
