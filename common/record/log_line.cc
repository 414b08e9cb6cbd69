#include "common/record/log_line.h"

#include <charconv>

#include "common/message/descriptor_builder.h"
#include "common/record/notes.h"
#include "common/record/session_encoder.h"

namespace palp::record {
namespace {

using message::DescriptorBuilder;

// FieldDescriptorProto.Type
constexpr unsigned kInt64 = 3;
constexpr unsigned kInt32 = 5;
constexpr unsigned kString = 9;
constexpr unsigned kMessage = 11;
constexpr unsigned kEnum = 14;

void add_field(DescriptorBuilder& to,
               std::string_view name,
               unsigned number,
               unsigned type,
               std::string_view type_name = {}) {
  DescriptorBuilder field;
  field.text(1, name);
  field.number(3, number);
  field.number(4, 1);  // LABEL_OPTIONAL
  field.number(5, type);
  if (!type_name.empty()) field.text(6, type_name);
  to.part(2, field.bytes());
}

/// A file of one message.
Bytes file_of(std::string_view name,
              std::string_view package,
              std::string_view imports,
              const DescriptorBuilder& message) {
  DescriptorBuilder file;
  file.text(1, name);
  file.text(2, package);
  if (!imports.empty()) file.text(3, imports);
  file.part(4, message.bytes());
  file.text(12, "proto3");
  return file.bytes();
}

DescriptorBuilder level_enum() {
  DescriptorBuilder level;
  level.text(1, "Level");
  unsigned number = 0;
  for (const char* name : {"UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"}) {
    DescriptorBuilder value;
    value.text(1, name);
    value.number(2, number++);
    level.part(2, value.bytes());
  }
  return level;
}

/// Four digits, as short as they can be: "2", "3.142".
std::string detail_text(double detail) {
  std::array<char, 32> room{};
  const auto end =
      std::to_chars(room.data(), room.data() + room.size(), detail, std::chars_format::general, 4);
  return {room.data(), end.ptr};
}

LogLevel level_of(SiteState state) noexcept {
  if (state == SiteState::Stopped) return LogLevel::Error;
  return state == SiteState::Hold || state == SiteState::Retract ? LogLevel::Warning
                                                                 : LogLevel::Info;
}

LogLevel level_of(NoteCode code) noexcept {
  switch (code) {
    case NoteCode::NotFinite:
      return LogLevel::Error;
    case NoteCode::EngageRefusedForce:
    case NoteCode::ForceGateClamped:
    case NoteCode::MotionGateLimited:
    case NoteCode::ForceRetreat:
    case NoteCode::RoundTripTooLong:
    case NoteCode::LinkHolds:
    case NoteCode::LinkIsLost:
    case NoteCode::DragRefused:
    case NoteCode::PlaceBeyondTravel:
    case NoteCode::ForceIncomplete:
    case NoteCode::TissueTooStiff:
    case NoteCode::TipFeelsMore:
    case NoteCode::TipElsewhere:
    case NoteCode::DiskNearlyFull:
      return LogLevel::Warning;
    default:
      return LogLevel::Info;
  }
}

}  // namespace

std::optional<LogLine> log_line_of(const Record& record, link::Role site) {
  LogLine line{.level = LogLevel::Info, .site = site_name(site), .text = {}};
  if (const auto* note = std::get_if<Note>(&record)) {
    line.level = level_of(static_cast<NoteCode>(note->code));
    line.text = note_text(note->code);
    if (note->detail != 0) line.text += " (" + detail_text(note->detail) + ")";
  } else if (const auto* change = std::get_if<Transition>(&record)) {
    line.level = level_of(change->to);
    line.text = std::string{to_string(change->from)} + " -> " + std::string{to_string(change->to)} +
                ": " + std::string{note_text(change->reason)};
  } else {
    return std::nullopt;
  }
  return line;
}

Bytes log_line_descriptors() {
  DescriptorBuilder timestamp;
  timestamp.text(1, "Timestamp");
  add_field(timestamp, "seconds", 1, kInt64);
  add_field(timestamp, "nanos", 2, kInt32);
  DescriptorBuilder log;
  log.text(1, "Log");
  add_field(log, "timestamp", 1, kMessage, ".google.protobuf.Timestamp");
  add_field(log, "level", 2, kEnum, ".foxglove.Log.Level");
  add_field(log, "message", 3, kString);
  add_field(log, "name", 4, kString);
  log.part(4, level_enum().bytes());
  constexpr std::string_view kTimestampFile{"google/protobuf/timestamp.proto"};
  DescriptorBuilder set;
  set.part(1, file_of(kTimestampFile, "google.protobuf", {}, timestamp));
  set.part(1, file_of("foxglove/Log.proto", "foxglove", kTimestampFile, log));
  return set.bytes();
}

Bytes log_line_bytes(const LogLine& line, std::uint64_t stamp) {
  constexpr std::uint64_t kSecond = 1'000'000'000;  // [ns]
  DescriptorBuilder time;                           // a message is a message
  time.number(1, stamp / kSecond);
  time.number(2, stamp % kSecond);
  DescriptorBuilder log;
  log.part(1, time.bytes());
  log.number(2, static_cast<std::uint64_t>(line.level));
  log.text(3, line.text);
  log.text(4, line.site);
  return log.bytes();
}

}  // namespace palp::record
