// Input: a byte for the schema, then one message of a session file.
#include <algorithm>
#include <vector>

#include "common/core/check.h"
#include "common/record/session_decoder.h"
#include "common/record/session_encoder.h"
#include "tests/fuzz/fuzz.h"

namespace palp::record {
namespace {

using Verdict = SessionDecoder::Verdict;

Bytes encoded(SessionEncoder& encoder, const Record& record) {
  const auto prepared = encoder.prepare(record, 0);
  PALP_CHECK(prepared.has_value(), "what came from a topic has a topic");
  Bytes bytes(prepared->size);
  encoder.store(bytes.data());
  return bytes;
}

void message_laws(link::Role site,
                  const std::vector<TopicFormat>& topics,
                  const std::string& schema,
                  std::span<const std::byte> payload) {
  const TimePoint at{std::chrono::milliseconds{42}};
  SessionDecoder::Parts parts;
  const Verdict verdict = SessionDecoder::decode(schema, payload, at, parts);
  PALP_CHECK(verdict != Verdict::Unknown, "every topic's schema is known");
  PALP_CHECK((verdict == Verdict::Decoded) == (parts.size() > 0), "what is decoded has records");
  SessionEncoder encoder{site};
  while (const auto record = parts.take()) {
    // Bytes are compared, because a record may hold NaN.
    const Bytes bytes = encoded(encoder, *record);
    const auto topic = encoder.prepare(*record, 0)->topic;
    const auto format = std::ranges::find(topics, topic, &TopicFormat::topic);
    SessionDecoder::Parts again;
    PALP_CHECK(SessionDecoder::decode(format->schema, bytes, at, again) == Verdict::Decoded &&
                   again.size() == 1,
               "what was decoded can be written and read");
    const Record same = *again.take();
    PALP_CHECK(same.index() == record->index(), "a record stays of its kind");
    PALP_CHECK(encoded(encoder, same) == bytes, "what was decoded survives the file");
  }
}

}  // namespace
}  // namespace palp::record

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const auto kSurgeon = palp::record::topics_of(palp::link::Role::Surgeon);
  static const auto kPatient = palp::record::topics_of(palp::link::Role::Patient);
  const bool surgeon = *data % 2 == 0;
  const auto& topics = surgeon ? kSurgeon : kPatient;
  palp::record::message_laws(surgeon ? palp::link::Role::Surgeon : palp::link::Role::Patient,
                             topics,
                             topics[*data / 2 % topics.size()].schema,
                             palp::fuzz::as_bytes(data, size).subspan(1));
  return 0;
}
