#include "lab/run/session_files.h"

#include <gtest/gtest.h>

#include "common/config/document.h"
#include "common/record/session_reader.h"
#include "common/record/session_writer.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"

namespace palp::lab {
namespace {

Scenario short_run() {
  Scenario scenario = make_scenario("metro", load_scenario("metro").value()).value();
  scenario.duration = std::chrono::milliseconds{500};
  return scenario;
}

struct Told {
  std::string session;
  std::string settings;
  std::string began;
  std::uint64_t first{};  ///< [ns], stamp of the first message
};

Told told_by(std::span<const std::byte> file) {
  record::SessionReader reader{file};
  Told told;
  while (reader.next()) continue;
  if (!reader.sessions().empty()) told.session = reader.sessions().front().id;
  told.settings = reader.attachment("config.textproto").value_or("");
  told.began = reader.metadata("palp", "began_utc").value_or("");
  told.first = reader.clock().stamp(reader.began_at().value_or(TimePoint{}));
  return told;
}

TEST(SessionFilesTest, SayWhatTheFilesOfSitesSay) {
  record::MemorySink surgeon;
  record::MemorySink patient;
  (void)simulate(short_run(), {.surgeon = &surgeon, .patient = &patient});
  const Told here = told_by(surgeon.bytes());
  const Told there = told_by(patient.bytes());
  EXPECT_EQ(here.session.size(), 16U);
  EXPECT_EQ(here.session, there.session);
  EXPECT_EQ(here.began, "2000-01-01T00:00:00.000000000Z");
  EXPECT_EQ(there.began, here.began) << "one world, whatever the clocks of the sites";
  auto document = config::surgeon_document();
  EXPECT_TRUE(document.merge(here.settings, "file"));
  auto other = config::patient_document();
  EXPECT_TRUE(other.merge(there.settings, "file"));
}

TEST(SessionFilesTest, ClocksThatDifferMeetOnTheWall) {
  Scenario scenario = short_run();
  scenario.fault.kind = FaultKind::LiftPedal;
  record::MemorySink surgeon;
  record::MemorySink patient;
  (void)simulate(scenario, {.surgeon = &surgeon, .patient = &patient});
  EXPECT_EQ(told_by(surgeon.bytes()).first, told_by(patient.bytes()).first);
}

TEST(SessionFilesTest, ABareRunHasNone) {
  Scenario scenario = short_run();
  scenario.bare = true;
  SessionFiles files{scenario, {}, TimePoint{}};
  EXPECT_EQ(files.surgeon(), nullptr);
  EXPECT_EQ(files.records(), 0U);
  files.close();
}

/// [bytes] of a file without what the lab alone writes into it.
std::size_t size_of_a_sites(std::span<const std::byte> file, link::Role site) {
  record::MemorySink sink;
  record::SessionWriter writer{sink, {.site = site}};
  record::SessionReader reader{file};
  while (const auto entry = reader.next()) {
    if (!std::holds_alternative<PlantTruth>(entry->record)) writer.write(entry->record);
  }
  writer.close();
  return sink.bytes().size();
}

TEST(SessionFilesTest, AnHourOfStandardSessionsTakesLessThanHalfAGigabyteAtASite) {
  const Scenario scenario = make_scenario("standard", load_scenario("standard").value()).value();
  record::MemorySink surgeon;
  record::MemorySink patient;
  const RunResult run = simulate(scenario, {.surgeon = &surgeon, .patient = &patient});
  const double most = 0.45e9 * seconds(run.virtual_span) / 3600;  // [bytes], of 0.45 GB an hour
  EXPECT_LE(size_of_a_sites(surgeon.bytes(), link::Role::Surgeon), most);
  EXPECT_LE(size_of_a_sites(patient.bytes(), link::Role::Patient), most);
}

}  // namespace
}  // namespace palp::lab
