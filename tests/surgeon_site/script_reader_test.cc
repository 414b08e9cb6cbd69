#include "surgeon_site/script_reader.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kStiffness = 300;  // [N/m]

std::string refusal(const std::string& text) {
  const Result<GestureScript> script = parse_script(text, kStiffness);
  return script ? "accepted" : script.error().text;
}

std::string replay_refusal(const std::string& text) {
  const Result<GestureScript> script = parse_replay(text);
  return script ? "accepted" : script.error().text;
}

TEST(ScriptReaderTest, ALineOfManyPiecesIsRefusedAsAnyOther) {
  std::string words = "hold";
  for (int i = 0; i < 100'000; ++i) words += " 1";
  EXPECT_FALSE(parse_script(words, 1000));
  EXPECT_FALSE(parse_replay("t_s,position_mm\n" + std::string(100'000, ',')));
  EXPECT_FALSE(parse_replay(std::string(100'000, ',') + "\n0,0\n1,1\n"));
}

TEST(ScriptReaderTest, StandardPalpationAsTextIsTheStandardPalpation) {
  const std::string site = "move -3 0.5\ntaps 4 4 1 0.5\npress 2 0.6 2\npress 4 .4 2\nlift 0.6 2\n";
  const Result<GestureScript> read = parse_script(
      "# the standard palpation\nhold 1\n\nair 5 1 4  # free air\nhold 0.5\r\nsite A\n" + site +
          "site B\n" + site,
      kStiffness);
  ASSERT_TRUE(read) << read.error().text;
  const GestureScript standard = standard_script({kStiffness, {}});
  ASSERT_EQ(read->length(), standard.length());
  for (Duration t{}; t <= standard.length(); t += 7ms) {
    ASSERT_EQ(read->at(t).position, standard.at(t).position) << seconds(t);
    ASSERT_EQ(read->at(t).place, standard.at(t).place) << seconds(t);
  }
}

TEST(ScriptReaderTest, LastLineNeedsNoNewline) {
  EXPECT_TRUE(parse_script("hold 1", kStiffness));
  EXPECT_TRUE(parse_script("hold 1\nsite 12.5\ntaps 1 20 0.02 0", kStiffness));
}

TEST(ScriptReaderTest, RefusalsNameLineWordAndWhatWasExpected) {
  EXPECT_THAT(refusal("hold 1\n\ntab 4"), AllOf(HasSubstr("line 3"), HasSubstr("'tab'")));
  EXPECT_THAT(refusal("hold"), AllOf(HasSubstr("line 1"), HasSubstr("hold SECONDS")));
  EXPECT_THAT(refusal("hold 1 2"), AllOf(HasSubstr("hold SECONDS"), HasSubstr("2 value")));
  EXPECT_THAT(refusal("taps 4 4 one 0.5"), AllOf(HasSubstr("SECONDS 'one'"), HasSubstr("number")));
  EXPECT_THAT(refusal("hold 1s"), HasSubstr("'1s' is not a number"));
  EXPECT_THAT(refusal("hold nan"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("hold inf"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("taps 1.5 4 1 0"), AllOf(HasSubstr("COUNT 1.5"), HasSubstr("whole number")));
  EXPECT_THAT(refusal("site C"), HasSubstr("PLACE 'C' is neither A, B nor X_MM,Y_MM"));
  EXPECT_THAT(refusal(""), HasSubstr("no phase"));
  EXPECT_THAT(refusal("# nothing\nsite B\n"), HasSubstr("no phase"));
}

TEST(ScriptReaderTest, ASearchSaysHowManyTapsAtMostAndWhereItBegins) {
  const Result<GestureScript> script = parse_script("search 4 taps from 8,2\nlift 1 1", kStiffness);
  ASSERT_TRUE(script) << script.error().text;
  const auto taps = std::count_if(script->stretches().begin(),
                                  script->stretches().end(),
                                  [](const Stretch& one) { return one.kind == StretchKind::Tap; });
  EXPECT_EQ(taps, 4);
  EXPECT_EQ(script->at(script->length()).place, (Place{8e-3, 2e-3}));
  EXPECT_THAT(refusal("search 2 taps from B"), HasSubstr("COUNT 2"));
  EXPECT_THAT(refusal("search 101 taps from B"), HasSubstr("COUNT 101"));
  EXPECT_THAT(refusal("search 4 taps"), HasSubstr("search COUNT taps from PLACE"));
  EXPECT_THAT(refusal("press 4 1 1\nsearch 4 taps from B"), HasSubstr("lift first"));
}

TEST(ScriptReaderTest, BordersOfEveryRange) {
  EXPECT_EQ(refusal("press 20 0.6 2"), "accepted");
  EXPECT_THAT(refusal("press 20.001 0.6 2"), HasSubstr("DEPTH_MM 20.001"));
  EXPECT_THAT(refusal("press 0 0.6 2"), HasSubstr("above 0"));
  EXPECT_EQ(refusal("hold 0.02"), "accepted");
  EXPECT_THAT(refusal("hold 0.019"), HasSubstr("SECONDS 0.019"));
  EXPECT_EQ(refusal("hold 3600"), "accepted");
  EXPECT_THAT(refusal("hold 3600.1"), HasSubstr("to 3600"));
  EXPECT_EQ(refusal("move -60 1"), "accepted");
  EXPECT_THAT(refusal("move -60.1 1"), HasSubstr("POSITION_MM"));
  EXPECT_EQ(refusal("taps 1000 4 1 0"), "accepted");
  EXPECT_THAT(refusal("taps 0 4 1 0"), HasSubstr("COUNT 0"));
  EXPECT_THAT(refusal("taps 1001 4 1 0"), HasSubstr("COUNT 1001"));
  EXPECT_EQ(refusal("hold 3600\nhold 3600\nhold 3600\nhold 3600"), "accepted");
  EXPECT_THAT(refusal("hold 3600\nhold 3600\nhold 3600\nhold 3600\nhold 1"),
              AllOf(HasSubstr("line 5"), HasSubstr("4 hours")));
}

TEST(ScriptReaderTest, FreeAirStaysFreeAndEndsWhereItBegan) {
  EXPECT_EQ(refusal("air 10 1 4"), "accepted");
  EXPECT_THAT(refusal("air 10.1 1 4"), HasSubstr("free air"));
  EXPECT_THAT(refusal("air 5 1 4.3"), HasSubstr("whole number of cycles"));
  EXPECT_THAT(refusal("air 5 0.00001 0.02"), HasSubstr("whole number of cycles"));
}

TEST(ScriptReaderTest, SiteChangesOnlyClearOfTheTissue) {
  EXPECT_EQ(refusal("press 4 1 1\nlift 1 1\nsite B\nhold 1"), "accepted");
  EXPECT_THAT(refusal("press 4 1 1\nsite B\nhold 1"),
              AllOf(HasSubstr("line 2"), HasSubstr("lift first")));
}

TEST(ScriptReaderTest, PlacesAreNamedByTheirCoordinates) {
  const Result<GestureScript> script = parse_script(
      "site 12.5,3\nhold 1\nmove to -4,1\ntap 2 times at B\npress 3 0.5 1\ndrag to 8,-2 in 4 s\n"
      "lift 1 1\nsite 7\nhold 1\n",
      kStiffness);
  ASSERT_TRUE(script) << script.error().text;
  EXPECT_EQ(script->at(500ms).place, (Place{12.5e-3, 3e-3}));
  EXPECT_EQ(script->phase(2).name, "to -4,1");
  EXPECT_EQ(script->phase(5).name, "taps B");
  EXPECT_EQ(script->phase(7).name, "drag to 8,-2");
  EXPECT_EQ(script->at(script->length()).place, (Place{7e-3, 0}));
}

TEST(ScriptReaderTest, ADragGlidesAtThePressedDepth) {
  const Result<GestureScript> script =
      parse_script("press 3 0.5 1\ndrag to 8,-2 in 4 s\n", kStiffness);
  ASSERT_TRUE(script) << script.error().text;
  const double depth = script->at(1s).position;
  for (const Duration at : {1500ms, 2500ms, 3500ms, 5500ms}) {
    EXPECT_EQ(script->at(at).position, depth);
    EXPECT_EQ(script->at(at).velocity, 0);
  }
  EXPECT_NEAR(distance(script->at(3500ms).place, {4e-3, -1e-3}), 0, 1e-12);
  EXPECT_EQ(script->at(5500ms).place, (Place{8e-3, -2e-3}));
}

TEST(ScriptReaderTest, TravelIsNoFasterThanAHand) {
  const Result<GestureScript> script = parse_script("move to 150,-120\nhold 1\n", kStiffness);
  ASSERT_TRUE(script) << script.error().text;
  for (Duration at{}; at < script->length(); at += 1ms) {
    ASSERT_LE(distance(script->at(at).place, script->at(at + 1ms).place), 0.1e-3 + 1e-9);
  }
}

TEST(ScriptReaderTest, PlacesHaveBordersAndTheirPhasesAnOrder) {
  EXPECT_EQ(refusal("site -200,200\nhold 1"), "accepted");
  EXPECT_THAT(refusal("site 200.1,0\nhold 1"), HasSubstr("X_MM 200.1 must be from -200 to 200"));
  EXPECT_THAT(refusal("site 0,-200.1\nhold 1"), HasSubstr("Y_MM -200.1"));
  EXPECT_THAT(refusal("site 300\nhold 1"), HasSubstr("X_MM 300"));
  EXPECT_THAT(refusal("site 1,\nhold 1"), HasSubstr("Y_MM '' is not a number"));
  EXPECT_THAT(refusal("site 1,2,3\nhold 1"), HasSubstr("Y_MM '2,3'"));
  EXPECT_THAT(refusal("drag to B in 4 s"), HasSubstr("press first"));
  EXPECT_THAT(refusal("press 3 1 1\ndrag to B in 4"), HasSubstr("drag to PLACE in SECONDS s"));
  EXPECT_THAT(refusal("press 3 1 1\ndrag to B in 0.01 s"), HasSubstr("SECONDS 0.01"));
  EXPECT_THAT(refusal("press 3 1 1\nmove to B"), HasSubstr("'move to' needs the hand clear"));
  EXPECT_THAT(refusal("press 3 1 1\ntap 1 times at B"), HasSubstr("'tap' needs the hand clear"));
  EXPECT_THAT(refusal("tap 0 times at B"), HasSubstr("COUNT 0"));
  EXPECT_THAT(refusal("tap 4 at B"), HasSubstr("tap COUNT times at PLACE"));
}

TEST(ScriptReaderTest, ARecordedHandMayHaveAPlane) {
  const Result<GestureScript> script =
      parse_replay("t_s,position_mm,x_mm,y_mm\n0,-10,1,2\n1,-9,3,-4\n");
  ASSERT_TRUE(script) << script.error().text;
  EXPECT_NEAR(distance(script->at(500ms).place, {2e-3, -1e-3}), 0, 1e-12);
  EXPECT_THAT(replay_refusal("t_s,position_mm,x_mm\n0,0,0\n1,0,0\n"), HasSubstr("y_mm"));
  EXPECT_THAT(replay_refusal("t_s,position_mm,x_mm,y_mm\n0,0,0,201\n1,0,0,0\n"),
              HasSubstr("y_mm 201"));
}

TEST(ScriptReaderTest, ReplayStartsAtItsFirstRow) {
  const Result<GestureScript> script =
      parse_replay("t_s,position_mm,lateral_mm\r\n5.0,-10,0\r\n5.5,-9,0\n\n6,-9,20\n");
  ASSERT_TRUE(script) << script.error().text;
  EXPECT_EQ(script->length(), 1s);
  EXPECT_NEAR(script->at(250ms).position, -9.5e-3, 1e-12);
  EXPECT_NEAR(script->at(1s).place.x, 20e-3, 1e-12);
}

TEST(ScriptReaderTest, ReplayRefusalsNameLineAndValue) {
  EXPECT_THAT(replay_refusal(""), HasSubstr("header"));
  EXPECT_THAT(replay_refusal("t_s,position_m\n0,0\n1,0\n"), HasSubstr("line 1"));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n0,0\n"), HasSubstr("two rows"));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n0,0\n0,1\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("does not rise")));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n1,0\n0.5,1\n"), HasSubstr("does not rise"));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n0,x\n1,0\n"), HasSubstr("position_mm 'x'"));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n0,1e9\n1,0\n"), HasSubstr("position_mm"));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n0,0,0\n1,0\n"), HasSubstr("expected 2 columns"));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n0,\n1,0\n"), HasSubstr("''"));
  EXPECT_THAT(replay_refusal("t_s,position_mm\n0,0\n1e9,0\n"), HasSubstr("4 hours"));
}

}  // namespace
}  // namespace palp::surgeon
