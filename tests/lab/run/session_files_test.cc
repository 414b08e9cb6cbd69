#include "lab/run/session_files.h"

#include <gtest/gtest.h>

#include "common/config/document.h"
#include "common/record/session_reader.h"
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

}  // namespace
}  // namespace palp::lab
