#include "review/lack.h"

#include "common/core/printable.h"

namespace palp::review {

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
    if (const std::uint64_t missing = topic.sequence.missing(); missing > 0) {
      return std::to_string(missing) + " messages are missing on topic " + printable(name);
    }
    if (const std::uint64_t wrong = topic.sequence.disordered(); wrong > 0) {
      return std::to_string(wrong) + " messages stand twice or not in their order on topic " +
             printable(name);
    }
    if (topic.dated_back > 0) {
      return std::to_string(topic.dated_back) +
             " messages are older than the one before on topic " + printable(name);
    }
  }
  const auto messages = reader.metadata("palp.summary", "messages");
  if (messages && !reader.partial() && *messages != std::to_string(report.messages)) {
    return "the writer counted " + printable(*messages) + " messages, the file has " +
           std::to_string(report.messages);
  }
  return std::nullopt;
}

std::string lack_of(const record::SessionReader& reader) {
  std::string text;
  const auto add = [&text](const std::string& words) {
    text += (text.empty() ? "" : ", ") + words;
  };
  if (const auto chunks = reader.metadata(kRecoveredRecord, "chunks_damaged")) {
    add(reader.metadata(kRecoveredRecord, "was_closed") == "no"
            ? "was recovered from one that was not closed, and lacks what came after its last "
              "message"
            : "was recovered from a damaged one");
    if (*chunks != "0") add("lacks " + printable(*chunks) + " chunks that could not be read");
  }
  const record::McapReadReport& report = reader.report();
  if (!report.closed) add("was not closed, and lacks what came after its last message");
  if (report.chunks_damaged > 0) {
    add("has " + std::to_string(report.chunks_damaged) + " chunks that cannot be read");
  }
  const auto dropped = reader.metadata("palp.summary", "records_dropped");
  if (dropped && *dropped != "0") {
    add("lacks " + printable(*dropped) + " records that were lost as it was written");
  }
  if (reader.missing() > 0) add("lacks " + std::to_string(reader.missing()) + " messages");
  if (reader.disordered() > 0) {
    add("has " + std::to_string(reader.disordered()) + " messages twice or not in their order");
  }
  if (reader.dated_back() > 0) {
    add("has " + std::to_string(reader.dated_back()) + " ticks that are older than the one before");
  }
  if (reader.malformed() > 0) {
    add("has " + std::to_string(reader.malformed()) + " messages that cannot be decoded");
  }
  if (report.fault_count > report.chunks_damaged || text.empty()) {
    if (const auto fault = fault_of(reader)) add("has a fault: " + *fault);
  }
  return text;
}

}  // namespace palp::review
