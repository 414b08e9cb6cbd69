#include <algorithm>
#include <cstring>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "common/record/session_reader.h"
#include "common/record/session_writer.h"
#include "tests/common/message/draw.h"
#include "tests/common/record/record_samples.h"

namespace palp::record {
namespace {

using link::Role;
using test::at_ms;
using test::fields;

/// What a site writes, with any bit pattern of a double, NaN and -0 among them: the file must not
/// look at values. Its writer says itself how many records were dropped.
Record any_record(Role site) {
  message::Draw draw{*rc::gen::arbitrary<std::uint64_t>()};
  const auto any = [&]<class Struct>(Struct one) -> Record {
    message::draw_into<message::Form::Log>(one, draw);
    if constexpr (requires { one.health; }) {
      one.health.session_id = one.health.newest_number = one.health.key = 0;  // not in the file
      one.records_dropped = 0;
    }
    return one;
  };
  const bool surgeon = site == Role::Surgeon;
  switch (draw.below(13)) {
    case 0:
      return any(SiteTick{});
    case 1:
      return any(Arrived{});
    case 2:
      return any(LinkStatus{});
    case 3:
      return any(Note{});
    case 4:
      return any(Transition{});
    case 5:
      return surgeon ? any(DepthArrived{}) : any(DepthEstimate{});
    case 6:
      return surgeon ? any(HandReading{}) : any(StageReading{});
    case 7:
      return any(LinkHeard{});
    case 8:
      return any(UserAsked{});
    case 9:
      return any(DevicesTold{});
    case 10:
      return surgeon ? any(MapArrived{}) : any(MapEstimate{});
    case 11:
      return any(MapCell{});
    default:
      if (surgeon) return any(PlantTruth{});
      return any(ForceReading{});
  }
}

std::vector<SessionEntry> read_all(SessionReader& reader) {
  std::vector<SessionEntry> entries;
  while (auto entry = reader.next()) {
    entries.push_back(*entry);
  }
  return entries;
}

bool is_given(const Record& record) {
  return std::holds_alternative<SiteTick>(record) || std::holds_alternative<Arrived>(record) ||
         std::holds_alternative<HandReading>(record) ||
         std::holds_alternative<StageReading>(record) ||
         std::holds_alternative<ForceReading>(record) || std::holds_alternative<LinkHeard>(record);
}

RC_GTEST_PROP(SessionTest, WhatIsWrittenIsReadBackBitForBit, ()) {
  const Role site = *rc::gen::element(Role::Surgeon, Role::Patient);
  const int count = *rc::gen::inRange(0, 40);
  std::vector<Record> written;
  MemorySink sink;
  {
    SessionWriter writer{sink, {.site = site}};
    for (int k = 0; k < count; ++k) {
      written.push_back(any_record(site));
      RC_ASSERT(writer.write(written.back()));
    }
  }
  SessionReader reader{sink.bytes()};
  const auto entries = read_all(reader);
  RC_ASSERT(entries.size() == written.size());
  std::vector<Record> read;
  for (const SessionEntry& entry : entries) {
    RC_ASSERT(entry.site == site);
    read.push_back(entry.record);
  }
  // What a tick was given stands together, behind what else was said meanwhile.
  std::ranges::stable_partition(written, is_given);
  std::ranges::stable_partition(read, is_given);
  for (std::size_t k = 0; k < written.size(); ++k) {
    RC_ASSERT(fields(read[k]) == fields(written[k]));
  }
  RC_ASSERT(reader.malformed() == 0u);
  RC_ASSERT(reader.report().fault_count == 0u);
  RC_ASSERT(reader.report().closed);
}

/// A session of five seconds with all that a patient's site writes.
struct WrittenSession {
  MemorySink sink;
  SessionCounts counts;
  std::uint64_t messages{};
};

WrittenSession five_seconds() {
  WrittenSession session;
  SessionWriter writer{session.sink,
                       {.site = Role::Patient,
                        .metadata = {{"program", "palp-patient"}, {"seed", "42"}},
                        .attachments = {{"tissue.csv", "text/csv", "site,d_mm,F_N\n"}}}};
  for (int k = 0; k < 5000; ++k) {
    writer.write(test::tick(k));
    writer.write(Arrived{.at = at_ms(k), .incoming = {}});
    if (k % 100 == 0) {
      writer.set_dropped(static_cast<std::uint64_t>(k));
      writer.write(LinkStatus{.at = at_ms(k), .health = {}});
    }
  }
  writer.close();
  session.counts = writer.counts();
  session.messages = writer.messages();
  return session;
}

TEST(SessionTest, StatisticsEqualTheWritersCounters) {
  const auto session = five_seconds();
  McapReader reader{session.sink.bytes()};
  std::optional<McapStatistics> statistics;
  while (const auto item = reader.next()) {
    if (const auto* found = std::get_if<McapStatistics>(&*item)) {
      statistics = *found;
    }
  }
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->messages, session.messages);
  EXPECT_EQ(statistics->messages, session.counts.messages());
  EXPECT_EQ(session.counts.records(), 10050u);
  EXPECT_EQ(statistics->begin, 0U) << "instant of the first sample [ns]";
  EXPECT_EQ(statistics->chunks, 10u) << "one each half second";
}

/// Takes `room` [bytes], then no more.
class FullDisk final : public ByteSink {
 public:
  explicit FullDisk(std::size_t room) : room_{room} {}
  bool write(std::span<const std::byte> bytes) noexcept override {
    if (bytes.size() > room_) return false;
    room_ -= bytes.size();
    return true;
  }

 private:
  std::size_t room_;
};

TEST(SessionTest, AfterAFullDiskTheCountsAreThoseOfTheFile) {
  for (const std::size_t room : {30'000U, 60'000U, 90'000U}) {
    FullDisk disk{room};
    SessionWriter writer{disk, {.site = Role::Surgeon}};
    std::uint64_t handed = 0;
    for (int k = 0; k < 100'000 && !writer.failed(); ++k, ++handed) {
      (void)writer.write(test::tick(k));
    }
    writer.close();
    ASSERT_TRUE(writer.failed());
    EXPECT_EQ(writer.counts().messages(), writer.messages());
    EXPECT_GE(writer.messages() + writer.lost(), handed);
  }
}

TEST(SessionTest, ViewShowsFiftyPerSecondAndKeepsASpikeOfOneTick) {
  TickView view;
  for (int k = 0; k < 20; ++k) {
    SiteTick tick = test::tick(k);
    tick.force = k == 7 ? 2.5 : (k == 9 ? -1 : 0.25);
    view.add(tick);
  }
  EXPECT_EQ(view.force.max, 2.5);
  EXPECT_EQ(view.force.min, -1);
  EXPECT_EQ(view.force.newest, 0.25);

  const auto session = five_seconds();
  EXPECT_EQ(session.counts.views, 250u);
}

TEST(SessionTest, ViewKeepsItsRateWhenTicksComeALittleEarlyOrLate) {
  NullSink sink;
  SessionWriter writer{sink, {.site = Role::Surgeon}};
  for (int k = 0; k < 5000; ++k) {
    SiteTick tick = test::tick(k);
    tick.at += std::chrono::microseconds{(k * 7919) % 200 - 100};
    writer.write(tick);
  }
  writer.close();
  EXPECT_EQ(writer.counts().views, 250u);
}

TEST(SessionTest, MetadataAndAttachmentsStandBeforeTheFirstMessage) {
  const auto session = five_seconds();
  SessionReader reader{session.sink.bytes()};
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.metadata("palp", "site"), "patient");
  EXPECT_EQ(reader.metadata("palp", "seed"), "42");
  EXPECT_EQ(reader.metadata("palp", "nothing"), std::nullopt);
  EXPECT_EQ(reader.attachment("tissue.csv"), "site,d_mm,F_N\n");
  EXPECT_EQ(reader.attachment("other"), std::nullopt);
  read_all(reader);
  EXPECT_EQ(reader.metadata("palp.summary", "records_dropped"), "4900");
  EXPECT_EQ(reader.metadata("palp.summary", "tick"), "5000");
}

TEST(SessionTest, TopicsCarryTheSamplesOwnInstantAndNoGap) {
  const auto session = five_seconds();
  SessionReader reader{session.sink.bytes()};
  read_all(reader);
  const TopicCount& ticks = reader.topics().at("patient/tick");
  EXPECT_EQ(ticks.messages, 5000u);
  EXPECT_EQ(ticks.first, at_ms(0));
  EXPECT_EQ(ticks.last, at_ms(4999));
  EXPECT_EQ(ticks.sequence.missing(), 0u);
  EXPECT_EQ(ticks.schema, "palp.session.PatientTick");
  EXPECT_EQ(reader.began_at(), at_ms(0));
}

TEST(SessionTest, DamagedChunkShowsAsAGapOfEachTopic) {
  auto session = five_seconds();
  std::vector<std::byte> file{session.sink.bytes().begin(), session.sink.bytes().end()};
  file[file.size() / 2] ^= std::byte{1};
  SessionReader reader{file};
  const auto entries = read_all(reader);
  EXPECT_EQ(reader.report().chunks_damaged, 1u);
  EXPECT_LT(entries.size(), 10050u);
  const TopicCount& ticks = reader.topics().at("patient/tick");
  EXPECT_EQ(ticks.messages + ticks.sequence.missing(), 5000u);
}

TEST(SessionTest, RecordWithoutATopicAtThisSiteIsCountedNotWritten) {
  NullSink sink;
  SessionWriter surgeon{sink, {.site = Role::Surgeon}};
  EXPECT_FALSE(surgeon.write(ForceReading{}));
  EXPECT_FALSE(surgeon.write(DepthEstimate{}));
  EXPECT_EQ(surgeon.counts().misplaced, 2u);
  EXPECT_EQ(surgeon.messages(), 0u);
}

TEST(SessionTest, EveryTopicOfBothSitesHasItsOwnSchemaInTheFile) {
  for (const Role site : {Role::Surgeon, Role::Patient}) {
    MemorySink sink;
    { const SessionWriter writer{sink, {.site = site}}; }
    std::set<std::string> schemas;
    std::size_t channels = 0;
    McapReader reader{sink.bytes()};
    while (const auto item = reader.next()) {
      if (const auto* schema = std::get_if<McapSchema>(&*item)) {
        EXPECT_TRUE(schemas.insert(schema->name).second) << schema->name;
      }
      channels += std::holds_alternative<McapChannel>(*item) ? 1u : 0u;
    }
    EXPECT_EQ(channels, topics_of(site).size() + 1) << "and the log";
    EXPECT_EQ(schemas.size(), channels);
  }
}

TEST(SessionTest, AFileThatSaysNoEndOfThingsTakesNoEndOfMemory) {
  MemorySink sink;
  {
    McapWriter writer{sink, {}};
    writer.add_metadata("palp", {{"site", "surgeon"}});
    const std::string text(1U << 20U, 'x');
    for (int k = 0; k < 10; ++k) writer.add_metadata(std::to_string(k), {{"key", text}});
    for (int k = 0; k < 10'000; ++k) {
      const std::string name = std::to_string(k);
      writer.add_attachment({.name = name, .media_type = "text/plain", .data = {}});
    }
  }
  SessionReader reader{sink.bytes()};
  while (reader.next()) {
  }
  EXPECT_EQ(reader.metadata("palp", "site"), "surgeon");
  EXPECT_EQ(reader.metadata("0").size(), 1U);
  EXPECT_TRUE(reader.metadata("9").empty());
  EXPECT_TRUE(reader.attachment("0"));
  EXPECT_FALSE(reader.attachment("9999"));
}

TEST(SessionTest, WriteAfterCloseIsRefused) {
  NullSink sink;
  SessionWriter writer{sink, {.site = Role::Surgeon}};
  writer.close();
  EXPECT_FALSE(writer.write(test::tick(0)));
}

TEST(SessionTest, ValueOutsideItsEnumerationIsMalformedNotTrusted) {
  constexpr std::array kStateNine{std::byte{0x08}, std::byte{9}};
  constexpr std::array kStateTwo{std::byte{0x08}, std::byte{2}};
  constexpr std::array kCutOff{std::byte{0x08}};
  using Verdict = SessionDecoder::Verdict;
  const auto verdict = [&](std::string_view schema, std::span<const std::byte> payload) {
    SessionDecoder::Parts parts;
    return SessionDecoder::decode(schema, payload, at_ms(0), parts);
  };
  EXPECT_EQ(verdict("palp.session.PatientTick", kStateTwo), Verdict::Decoded);
  EXPECT_EQ(verdict("palp.session.PatientTick", kStateNine), Verdict::Malformed);
  EXPECT_EQ(verdict("palp.session.PatientTick", kCutOff), Verdict::Malformed);
  EXPECT_EQ(verdict("palp.session.LinkStatus", kStateNine), Verdict::Malformed);
  EXPECT_EQ(verdict("palp.session.PatientTickView", kStateTwo), Verdict::View);
  EXPECT_EQ(verdict("foxglove.Grid", kStateTwo), Verdict::Unknown);
}

/// `value` as the double of field `number`, below 16.
std::vector<std::byte> one_double(unsigned number, double value) {
  std::vector<std::byte> bytes(9);
  bytes[0] = static_cast<std::byte>(number << 3U | 1U);
  std::memcpy(&bytes[1], &value, sizeof value);
  return bytes;
}

TEST(SessionTest, TheLateralOfAnOldFileIsX) {
  const auto place = [&](std::string_view schema, unsigned number) {
    SessionDecoder::Parts parts;
    (void)SessionDecoder::decode(schema, one_double(number, 0.02), at_ms(0), parts);
    const Record record = parts.take().value();
    if (const auto* tick = std::get_if<SiteTick>(&record)) return tick->place;
    return std::get<DepthEstimate>(record).place;
  };
  EXPECT_EQ(place("palp.session.SurgeonTick", 6), kSiteB);
  EXPECT_EQ(place("palp.session.PatientTick", 6), kSiteB);
  EXPECT_EQ(place("palp.session.DepthEstimate", 4), kSiteB);
}

TEST(SessionTest, AContactSampleOfAnOldFileIsPassedOver) {
  for (const char* name : {"palp.session.ContactSample", "palp.session.ContactReading"}) {
    SessionDecoder::Parts parts;
    EXPECT_EQ(SessionDecoder::decode(name, one_double(1, 0), {}, parts),
              SessionDecoder::Verdict::Old);
    EXPECT_EQ(parts.size(), 0U);
  }
}

RC_GTEST_PROP(SessionTest, AnyBytesAreDecodedOrRefusedNeverTrusted, ()) {
  const auto bytes = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
  for (const Role site : {Role::Surgeon, Role::Patient}) {
    SessionEncoder encoder{site};
    for (const TopicFormat& format : topics_of(site)) {
      SessionDecoder::Parts parts;
      const auto verdict =
          SessionDecoder::decode(format.schema, std::as_bytes(std::span{bytes}), at_ms(5), parts);
      if (verdict == SessionDecoder::Verdict::Decoded && parts.size() == 1) {
        RC_ASSERT(encoder.prepare(*parts.take(), 0)->topic == format.topic);
      }
    }
  }
}

}  // namespace
}  // namespace palp::record
