#include "common/record/given_gatherer.h"

#include <gtest/gtest.h>

#include "common/record/byte_sink.h"
#include "common/record/session_reader.h"
#include "common/record/session_writer.h"

namespace palp::record {
namespace {

using link::Role;
using std::chrono_literals::operator""ms;

TimePoint at_ms(int value) { return TimePoint{std::chrono::milliseconds{value}}; }

Arrived sample(int ms, std::uint64_t number) {
  Arrived arrived{.at = at_ms(ms), .incoming = {}};
  arrived.incoming.number = number;
  arrived.incoming.arrived_at = at_ms(ms) - 7ms;
  arrived.incoming.sample.position = 1e-3 * static_cast<double>(number);
  return arrived;
}

/// Of a tick, without anything to tell.
template <class Part>
Part at_tick(int ms) {
  Part part;
  part.at = at_ms(ms);
  return part;
}

/// What a file of these says.
std::vector<Record> through_a_file(Role site, const std::vector<Record>& records) {
  MemorySink sink;
  {
    SessionWriter writer{sink, {.site = site}};
    for (const Record& record : records) EXPECT_TRUE(writer.write(record));
    writer.close();
    EXPECT_EQ(writer.counts().records(), records.size());
  }
  std::vector<Record> found;
  SessionReader reader{sink.bytes()};
  while (const auto entry = reader.next()) found.push_back(entry->record);
  return found;
}

std::vector<std::string> kinds(const std::vector<Record>& records) {
  std::vector<std::string> names;
  for (const Record& record : records) names.emplace_back(kRecordNames[record.index()]);
  return names;
}
using Names = std::vector<std::string>;

TEST(GivenGathererTest, ATickOfThePatientsIsOneMessageWithAllOfItsParts) {
  auto stage = at_tick<StageReading>(1);
  stage.age = 2ms;
  auto force = at_tick<ForceReading>(1);
  force.force = 3;
  auto heard = at_tick<LinkHeard>(1);
  heard.gap = 7ms;
  auto tick = at_tick<SiteTick>(1);
  tick.command = 4e-3;
  const std::vector<Record> records{sample(1, 5), tick, stage, force, heard};
  MemorySink sink;
  SessionWriter writer{sink, {.site = Role::Patient}};
  for (const Record& record : records) writer.write(record);
  writer.close();
  EXPECT_EQ(writer.messages(), 2U) << "tick, view";
  const auto found = through_a_file(Role::Patient, records);
  EXPECT_EQ(kinds(found), (Names{"arrived", "tick", "stage", "force", "heard"}));
  EXPECT_EQ(std::get<Arrived>(found[0]).incoming.number, 5U);
  EXPECT_EQ(std::get<SiteTick>(found[1]).command, 4e-3);
  EXPECT_EQ(std::get<StageReading>(found[2]).age, 2ms);
  EXPECT_EQ(std::get<ForceReading>(found[3]).force, 3);
  EXPECT_EQ(std::get<LinkHeard>(found[4]).gap, 7ms);
  for (std::size_t i = 1; i < found.size(); ++i) {
    std::visit(
        [](const auto& one) {
          if constexpr (requires { one.at; }) {
            EXPECT_EQ(one.at, at_ms(1));
          }
        },
        found[i]);
  }
}

TEST(GivenGathererTest, OfManySamplesTheLastTwoAreGatheredAndTheirOrderStays) {
  const auto found = through_a_file(Role::Surgeon,
                                    {sample(1, 4),
                                     sample(1, 5),
                                     sample(1, 6),
                                     sample(1, 7),
                                     at_tick<SiteTick>(1),
                                     at_tick<HandReading>(1),
                                     at_tick<LinkHeard>(1)});
  ASSERT_EQ(kinds(found),
            (Names{"arrived", "arrived", "arrived", "arrived", "tick", "hand", "heard"}));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(std::get<Arrived>(found[i]).incoming.number, 4 + i);
  }
}

TEST(GivenGathererTest, ATickThatLacksAReadingKeepsWhatItHas) {
  EXPECT_EQ(kinds(through_a_file(Role::Patient,
                                 {at_tick<StageReading>(1),
                                  at_tick<LinkHeard>(1),
                                  at_tick<ForceReading>(2),
                                  at_tick<StageReading>(3)})),
            (Names{"stage", "heard", "force", "stage"}));
}

TEST(GivenGathererTest, PartsOfTwoTicksAreNeverOne) {
  const auto found = through_a_file(
      Role::Patient, {at_tick<StageReading>(1), at_tick<ForceReading>(2), at_tick<LinkHeard>(2)});
  ASSERT_EQ(kinds(found), (Names{"stage", "force", "heard"}));
  EXPECT_EQ(std::get<StageReading>(found[0]).at, at_ms(1));
}

TEST(GivenGathererTest, WhatTheEstimatorSaysMeanwhileDisturbsNoTick) {
  EXPECT_EQ(kinds(through_a_file(Role::Patient,
                                 {at_tick<StageReading>(2),
                                  at_tick<ForceReading>(2),
                                  DepthEstimate{},
                                  at_tick<LinkHeard>(2)})),
            (Names{"depth_estimate", "stage", "force", "heard"}));
}

TEST(GivenGathererTest, NothingOfTheOtherSiteIsHeld) {
  GivenGatherer gatherer{Role::Surgeon};
  EXPECT_FALSE(gatherer.take(StageReading{}));
  EXPECT_FALSE(gatherer.take(LinkHeard{})) << "a tick begins with its reading";
  EXPECT_TRUE(gatherer.take(HandReading{}));
  EXPECT_FALSE(gatherer.take(LinkHeard{})) << "of what was decided there is nothing yet";
  gatherer.clear();
  EXPECT_TRUE(gatherer.take(SiteTick{}));
  EXPECT_TRUE(gatherer.take(HandReading{}));
  EXPECT_TRUE(gatherer.stands_in_the_way_of(HandReading{}));
  EXPECT_TRUE(gatherer.take(LinkHeard{}));
  EXPECT_TRUE(gatherer.whole());
}

}  // namespace
}  // namespace palp::record
