#include "site_program/site_report.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/io/process/diagnostics.h"
#include "tests/support/own_path.h"

namespace palp::site_program {
namespace {

using nlohmann::json;

TEST(SiteReportTest, HasTheKeysThatScriptsRelyOn) {
  const json report = json::parse(to_json({}));
  for (const char* key : {"site",
                          "outcome",
                          "reason",
                          "exit_code",
                          "seed",
                          "coupling",
                          "session_file",
                          "ticks",
                          "missed_ticks",
                          "lateness_p50_us",
                          "lateness_p99_us",
                          "lateness_p999_us",
                          "lateness_max_us",
                          "records_written",
                          "records_dropped",
                          "messages",
                          "sent",
                          "accepted",
                          "late",
                          "lost",
                          "repaired",
                          "reordered",
                          "stale",
                          "old_epoch",
                          "unsent",
                          "round_trip_p50_ms",
                          "round_trip_min_ms",
                          "clock",
                          "sessions"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  EXPECT_EQ(report["schema"], "palp.site/2");
  EXPECT_THAT(to_json({}), testing::StartsWith("{\n  \"schema\""));
  for (const char* key : {"malformed", "foreign", "replayed", "too_old", "forged"}) {
    EXPECT_TRUE(report["rejected"].contains(key)) << key;
  }
  EXPECT_TRUE(report["realtime"].contains("priority"));
  EXPECT_TRUE(report["realtime"].contains("memory_locked"));
  EXPECT_FALSE(report.contains("estimates")) << "the patient's only";
}

TEST(SiteReportTest, TheClockOfThePeerIsNullBeforeItIsKnown) {
  SiteReport made;
  EXPECT_TRUE(json::parse(to_json(made))["clock"].is_null());
  LinkHealth health;
  health.peer_clock = ClockOffset{.offset = std::chrono::milliseconds{-1500},
                                  .skew = 20e-6,
                                  .uncertainty = std::chrono::milliseconds{40},
                                  .at = {}};
  health.delay_in = std::chrono::milliseconds{41};
  made.round_trips.add(health);
  made.round_trips.add({});  // the session is over
  const json clock = json::parse(to_json(made))["clock"];
  EXPECT_EQ(clock["offset_ms"], -1500);
  EXPECT_EQ(clock["uncertainty_ms"], 40);
  EXPECT_NEAR(clock["skew_ppm"].get<double>(), 20, 1e-9);
  EXPECT_EQ(clock["delay_in_ms"], 41);
}

TEST(SiteReportTest, TheFiguresForTheFileAreThoseOfTheReportButForTheRecords) {
  SiteReport made;
  made.loop.ticks = 17;
  const json report = json::parse(to_json(made));
  const json figures = json::parse(figures_of(made));
  EXPECT_EQ(figures["ticks"], 17);
  for (const auto& [name, figure] : figures.items()) EXPECT_EQ(report[name], figure) << name;
  EXPECT_FALSE(figures.contains("records_written")) << "the file goes on until it is closed";
}

TEST(SiteReportTest, TheCountsByTypeAddUpToTheRecordsWritten) {
  SiteReport made;
  made.records.counts.by_type = {1, 2, 3, 4, 5, 6, 7, 8};
  const json report = json::parse(to_json(made));
  std::uint64_t sum = 0;
  for (const auto& [name, count] : report["records"].items()) sum += count.get<std::uint64_t>();
  EXPECT_EQ(sum, 36U);
  EXPECT_EQ(report["records_written"], 36U);
}

TEST(SiteReportTest, RejectionsOnAndBesideTheLinkAreOneSum) {
  SiteReport made;
  made.link.malformed = 1;
  made.noise.malformed = 2;
  made.link.foreign = 3;
  made.noise.foreign = 4;
  const json report = json::parse(to_json(made));
  EXPECT_EQ(report["rejected"]["malformed"], 3);
  EXPECT_EQ(report["rejected"]["foreign"], 7);
}

TEST(SiteReportTest, WhatWasNeverMeasuredIsNull) {
  SiteReport made;
  EXPECT_TRUE(json::parse(to_json(made))["round_trip_p50_ms"].is_null());
  LinkHealth link;
  link.round_trip = std::chrono::milliseconds{5};
  link.round_trip_min = std::chrono::milliseconds{4};
  made.round_trips.add(link);
  EXPECT_TRUE(json::parse(to_json(made))["round_trip_p50_ms"].is_null()) << "the link is down";
  link.state = LinkState::Live;
  made.round_trips.add(link);
  EXPECT_NEAR(json::parse(to_json(made))["round_trip_p50_ms"].get<double>(), 5, 0.2);
  EXPECT_EQ(json::parse(to_json(made))["round_trip_min_ms"], 4);
}

TEST(SiteReportTest, TextsThatAreNoUtf8DoNotBreakIt) {
  SiteReport made;
  made.session_file = "\xff.mcap";
  EXPECT_FALSE(json::parse(to_json(made)).empty());
}

TEST(FinishTest, ARecordingThatFailedIsNoSuccess) {
  using config::ExitCode;
  RecordAccount lost;
  lost.fault = "the disk is full";
  const ExitStatus done{ExitCode::Done, "completed", ""};
  EXPECT_EQ(with_recording(done, {}).code, ExitCode::Done);
  EXPECT_EQ(with_recording(done, lost).code, ExitCode::Missed);
  EXPECT_EQ(with_recording(done, lost).outcome, "completed");
  EXPECT_THAT(with_recording(done, lost).reason, testing::HasSubstr("the disk is full"));
  const ExitStatus cut{ExitCode::CutShort, "peer lost", "the peer is gone"};
  EXPECT_EQ(with_recording(cut, lost).code, ExitCode::CutShort);
  EXPECT_THAT(with_recording(cut, lost).reason, testing::StartsWith("the peer is gone"));
  SiteReport report;
  EXPECT_TRUE(json::parse(to_json(report))["recording_fault"].is_null());
  report.records = lost;
  EXPECT_EQ(json::parse(to_json(report))["recording_fault"], "the disk is full");
}

TEST(FinishTest, WritesTheReportAlsoOfAFailure) {
  const std::string path = test::own_path("finish.json");
  SiteReport report;
  report.exit_status = cannot_start("the port is taken");
  io::start_diagnostics("test");
  testing::internal::CaptureStderr();
  EXPECT_EQ(finish(report, path), 3);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("the port is taken"));
  std::ifstream file{path};
  const json read = json::parse(file);
  EXPECT_EQ(read["exit_code"], 3);
  EXPECT_EQ(read["reason"], "the port is taken");
  std::filesystem::remove(path);
}

TEST(FinishTest, AReportThatCannotBeWrittenFailsTheProgram) {
  SiteReport report;
  report.exit_status = {config::ExitCode::Done, "completed", ""};
  EXPECT_EQ(finish(report, ""), 0);
  EXPECT_EQ(finish(report, "/nowhere/at/all.json"), 3);
  report.exit_status = {config::ExitCode::CutShort, "aborted", ""};
  EXPECT_EQ(finish(report, "/nowhere/at/all.json"), 4) << "the first reason counts";
}

}  // namespace
}  // namespace palp::site_program
