#include "review/info.h"

#include "common/core/printable.h"
#include "common/record/session_reader.h"
#include "review/lack.h"
#include "review/text.h"

namespace palp::review {
namespace {

std::string describe_topics(const record::SessionReader& reader) {
  std::string text{left("topic", 22) + right("messages", 10) + right("rate Hz", 10) +
                   right("missing", 9) + "  schema\n"};
  for (const auto& [name, topic] : reader.topics()) {
    const double span = seconds(elapsed(topic.first, topic.last));
    const std::string rate =
        span > 0 ? fixed(static_cast<double>(topic.messages - 1) / span, 1) : "-";
    text += left(printable(name), 22) + right(std::to_string(topic.messages), 10) +
            right(rate, 10) + right(std::to_string(topic.sequence.missing()), 9) + "  " +
            printable(topic.schema) + '\n';
  }
  return text;
}

std::string describe_end(const record::SessionReader& reader) {
  const record::McapReadReport& report = reader.report();
  if (report.closed) {
    const std::string lack = lack_of(reader);
    return lack.empty() ? "closed in order\n" : "closed in order; the file " + lack + '\n';
  }
  std::string text{"the file was not closed; " + std::to_string(report.messages) +
                   " messages read"};
  if (reader.began_at() && reader.ended_at()) {
    text +=
        ", last at " + fixed(seconds(elapsed(*reader.began_at(), *reader.ended_at())), 3) + " s";
  }
  return text + "; " + std::to_string(report.bytes_unread) + " bytes at the end are of no use\n";
}

}  // namespace

std::string describe(const record::FileBytes& file) {
  record::SessionReader reader{file};
  std::uint64_t records = 0;
  while (reader.next()) {
    ++records;
  }
  std::string text;
  for (const auto& [key, value] : reader.metadata("palp")) {
    text += left(printable(key), 26) + harmless_line(value) + '\n';
  }
  for (const record::SessionName& session : reader.sessions()) {
    text += left("session " + printable(session.number), 26) + printable(session.id) + ", began " +
            printable(session.began_utc) + '\n';
  }
  if (reader.began_at() && reader.ended_at()) {
    text += left("duration", 26) +
            fixed(seconds(elapsed(*reader.began_at(), *reader.ended_at())), 3) + " s\n";
  }
  text += left("records", 26) + std::to_string(records);
  if (const auto dropped = reader.metadata("palp.summary", "records_dropped")) {
    text += ", dropped " + printable(*dropped);
  }
  text += '\n' + describe_topics(reader);
  const record::McapReadReport& report = reader.report();
  for (const record::McapFault& fault : report.faults) {
    text += "fault at byte " + std::to_string(fault.offset) + ": " + fault.text + '\n';
  }
  return text + describe_end(reader);
}

}  // namespace palp::review
