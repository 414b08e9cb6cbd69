#include "site_program/recording.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "common/io/process/diagnostics.h"
#include "common/io/realtime/steady_clock.h"
#include "common/record/mapped_file.h"
#include "common/record/notes.h"
#include "common/record/session_reader.h"
#include "tests/support/own_path.h"

namespace palp::site_program {
namespace {

/// Nothing is there yet.
std::string fresh_file() {
  const std::string path = test::own_path("recording.mcap");
  std::filesystem::remove(path);
  return path;
}

record::SessionInfo patient_info() {
  record::SessionInfo info;
  info.site = link::Role::Patient;
  return info;
}

TEST(RecordingTest, WhatAllWritersRecordedIsInTheFile) {
  const std::string path = fresh_file();
  Recording recording{{.file = path}, patient_info(), 2};
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(recording.recorder(0).record(SiteTick{}));
  }
  EXPECT_TRUE(recording.recorder(1).record(DepthEstimate{}));
  const RecordAccount& account = recording.stop();
  EXPECT_EQ(account.counts.records(), 101U);
  EXPECT_EQ(account.messages, account.counts.messages());
  EXPECT_EQ(account.dropped, 0U);
  EXPECT_GT(std::filesystem::file_size(path), 1000U);
  EXPECT_EQ(recording.stop().messages, account.messages) << "once more changes nothing";
}

TEST(RecordingTest, MarksAndThePeersIdentityAreInTheFile) {
  const std::string path = fresh_file();
  Recording recording{{.file = path}, patient_info(), 1};
  recording.mark(1, io::SteadyClock{}.now());
  recording.mark(3, io::SteadyClock{}.now());
  io::PeerIdentity peer;
  peer.session_id = 7;
  peer.name = "ward";
  peer.fingerprint = "ab12";
  recording.tell_of_peer(peer);
  (void)recording.stop();
  const auto file = record::MappedFile::open(path);
  ASSERT_TRUE(file);
  record::SessionReader reader{file->bytes()};
  std::vector<double> marks;
  while (const auto entry = reader.next()) {
    const auto* note = std::get_if<Note>(&entry->record);
    if (note == nullptr) continue;
    EXPECT_EQ(note->code, static_cast<std::uint16_t>(record::NoteCode::Marked));
    marks.push_back(note->detail);
  }
  EXPECT_EQ(marks, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(reader.metadata("palp.peer", "certificate_sha256"), "ab12");
  EXPECT_EQ(reader.metadata("palp.peer", "session_id"), record::session_id_text(7));
}

/// A tick of a session; 0: of none.
void record_tick(Recording& recording, std::uint64_t session_id) {
  LinkHeard heard;
  heard.session_id = session_id;
  EXPECT_TRUE(recording.recorder(0).record(SiteTick{}));
  EXPECT_TRUE(recording.recorder(0).record(heard));
}

struct FileOfSession {
  std::vector<std::string> ids;
  std::uint64_t ticks{};
  std::string number;
};

FileOfSession read_file(const std::string& path) {
  const auto file = record::MappedFile::open(path);
  EXPECT_TRUE(file) << path;
  record::SessionReader reader{file->bytes()};
  FileOfSession told;
  while (const auto entry = reader.next()) {
    if (std::holds_alternative<SiteTick>(entry->record)) ++told.ticks;
  }
  for (const record::SessionName& session : reader.sessions()) told.ids.push_back(session.id);
  told.number = reader.metadata("palp", "file_number").value_or("");
  return told;
}

TEST(RecordingTest, EachSessionHasAFileOfItsOwnFromItsFirstTickOn) {
  const std::string prefix = fresh_file() + "-";
  for (const char* number : {"001.mcap", "002.mcap"}) std::filesystem::remove(prefix + number);
  Recording recording{{.files = prefix}, patient_info(), 1};
  for (const std::uint64_t session : {0U, 7U, 7U, 0U, 9U, 9U, 9U}) record_tick(recording, session);
  const RecordAccount& account = recording.stop();
  EXPECT_EQ(account.fault, "");
  EXPECT_EQ(account.counts.records(), 14U);
  const FileOfSession first = read_file(prefix + "001.mcap");
  EXPECT_EQ(first.ids, std::vector<std::string>{"0000000000000007"});
  EXPECT_EQ(first.ticks, 4U);
  const FileOfSession second = read_file(prefix + "002.mcap");
  EXPECT_EQ(second.ids, std::vector<std::string>{"0000000000000009"});
  EXPECT_EQ(second.ticks, 3U);
  EXPECT_EQ(second.number, "2");
}

TEST(RecordingTest, WhereTheNextFileCannotBeginTheRecordsAreCountedAsLost) {
  const std::string prefix = fresh_file() + "-";
  std::filesystem::remove(prefix + "001.mcap");
  std::FILE* taken = std::fopen((prefix + "002.mcap").c_str(), "w");
  ASSERT_NE(taken, nullptr);
  std::fclose(taken);
  Recording recording{{.files = prefix}, patient_info(), 1};
  for (const std::uint64_t session : {7U, 9U}) record_tick(recording, session);
  const RecordAccount& account = recording.stop();
  EXPECT_THAT(account.fault, testing::HasSubstr("002.mcap"));
  EXPECT_EQ(account.counts.records(), 2U);
  EXPECT_EQ(account.dropped, 2U);
}

TEST(RecordingTest, WithoutAFileNothingIsWritten) {
  Recording recording{{}, patient_info(), 1};
  EXPECT_TRUE(recording.recorder(0).record(SiteTick{}));
  EXPECT_EQ(recording.stop().counts.records(), 0U);
}

TEST(RecordingTest, AnExistingFileIsNotTouched) {
  const std::string path = fresh_file();
  std::FILE* file = std::fopen(path.c_str(), "w");
  ASSERT_NE(file, nullptr);
  std::fputs("precious", file);
  std::fclose(file);
  EXPECT_THROW((Recording{{.file = path}, patient_info(), 1}), std::runtime_error);
  EXPECT_EQ(std::filesystem::file_size(path), 8U);
}

TEST(RecordingTest, AFullQueueIsCounted) {
  Recording recording{{.queue_records = 256}, patient_info(), 1};
  std::uint64_t refused = 0;
  for (int i = 0; i < 100'000; ++i) {
    if (!recording.recorder(0).record(SiteTick{})) ++refused;
  }
  EXPECT_GT(refused, 0U);
  EXPECT_EQ(recording.stop().dropped, refused);
}

std::string told(Recording& recording) {
  recording.stop();
  StatusLine line;
  io::start_diagnostics("test");
  testing::internal::CaptureStderr();
  recording.tell_news(line);
  return testing::internal::GetCapturedStderr();
}

TEST(RecordingTest, ChangesOfStateAreToldToPeople) {
  Recording recording{{}, patient_info(), 1};
  (void)recording.recorder(0).record(
      Transition{.from = SiteState::Engaged,
                 .to = SiteState::Hold,
                 .reason = static_cast<std::uint16_t>(record::NoteCode::GapHold)});
  EXPECT_THAT(told(recording), testing::HasSubstr("ENGAGED -> HOLD: nothing arrived: hold"));
}

TEST(RecordingTest, WhatRepeatsItselfIsToldOnce) {
  Recording recording{{}, patient_info(), 1};
  for (int i = 0; i < 20; ++i) {
    (void)recording.recorder(0).record(
        Note{.code = static_cast<std::uint16_t>(record::NoteCode::RoundTripTooLong)});
  }
  const std::string text = told(recording);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

TEST(RecordingTest, AFileRemovedMeanwhileIsALostRecording) {
  const std::string path = fresh_file();
  Recording recording{{.file = path}, patient_info(), 1};
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(recording.recorder(0).record(SiteTick{}));
  std::filesystem::remove(path);
  const RecordAccount& account = recording.stop();
  EXPECT_THAT(account.fault, testing::HasSubstr("removed"));
  EXPECT_EQ(account.counts.records(), 0U) << "nobody can read them";
  EXPECT_GE(account.dropped, 100U);
}

TEST(RecordingTest, AFullDiskIsToldWhileTheSessionGoesOn) {
  const std::string path = fresh_file();
  Recording recording{{.file = path}, patient_info(), 1};
  EXPECT_EQ(recording.alarm(), "");
  (void)std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{std::filesystem::file_size(path), before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  const io::SteadyClock clock;
  const TimePoint deadline = clock.now() + std::chrono::seconds{20};
  std::uint64_t recorded = 0;
  while (recording.alarm().empty() && clock.now() < deadline) {
    if (recording.recorder(0).record(SiteTick{})) ++recorded;
    std::this_thread::yield();
  }
  EXPECT_EQ(recording.alarm(), "RECORDING FAILED ");
  ::setrlimit(RLIMIT_FSIZE, &before);
  const RecordAccount& account = recording.stop();
  EXPECT_THAT(account.fault, testing::HasSubstr(path));
  EXPECT_EQ(account.counts.records(), 0U);
  EXPECT_GE(account.dropped, recorded);
  EXPECT_THAT(told(recording), testing::HasSubstr("RECORDING FAILED, the session goes on"));
}

TEST(RecordingTest, RecordsLostToAFullQueueAreALostRecording) {
  Recording recording{{.file = fresh_file(), .queue_records = 256}, patient_info(), 1};
  std::uint64_t refused = 0;
  while (refused == 0) {
    if (!recording.recorder(0).record(SiteTick{})) ++refused;
  }
  EXPECT_THAT(recording.stop().fault, testing::HasSubstr("lost"));
}

}  // namespace
}  // namespace palp::site_program
