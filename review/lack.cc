#include "review/lack.h"

#include "common/core/printable.h"

namespace palp::review {

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
  return text;
}

}  // namespace palp::review
