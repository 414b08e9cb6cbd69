#include "review/check.h"

#include "common/core/printable.h"
#include "common/record/session_reader.h"
#include "review/lack.h"

namespace palp::review {
namespace {

/// Of a file that was read to its end.
std::optional<std::string> fault_of(const record::SessionReader& reader) {
  const record::McapReadReport& report = reader.report();
  if (!report.faults.empty()) {
    return "at byte " + std::to_string(report.faults.front().offset) + ": " +
           report.faults.front().text;
  }
  if (!report.closed) {
    return "the file was not closed: " + std::to_string(report.messages) + " messages read, " +
           std::to_string(report.bytes_unread) + " bytes of no use at the end";
  }
  if (reader.malformed() > 0) {
    return "message " + printable(reader.first_malformed()) + " cannot be decoded (" +
           std::to_string(reader.malformed()) + " such messages)";
  }
  if (reader.unknown() > 0) {
    return std::to_string(reader.unknown()) + " messages are on topics of no session";
  }
  for (const auto& [name, topic] : reader.topics()) {
    if (topic.skipped > 0) {
      return std::to_string(topic.skipped) + " messages are missing on topic " + printable(name);
    }
  }
  const auto messages = reader.metadata("palp.summary", "messages");
  if (messages && *messages != std::to_string(report.messages)) {
    return "the writer counted " + printable(*messages) + " messages, the file has " +
           std::to_string(report.messages);
  }
  return std::nullopt;
}

}  // namespace

Checked checked(const record::FileBytes& file) {
  record::SessionReader reader{file};
  while (reader.next()) {
  }
  Checked found{.fault = fault_of(reader), .lack = {}};
  if (!found.fault) found.lack = lack_of(reader);
  return found;
}

}  // namespace palp::review
