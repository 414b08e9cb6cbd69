// Input: a byte for the schema, then one message of a session file.
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

void message_laws(link::Role site, const std::string& schema, std::span<const std::byte> payload) {
  const TimePoint at{std::chrono::milliseconds{42}};
  const auto first = SessionDecoder::decode(schema, payload, at);
  PALP_CHECK(first.verdict != Verdict::Unknown, "every topic's schema is known");
  if (first.verdict != Verdict::Decoded) return;
  // Bytes are compared, because a record may hold NaN.
  SessionEncoder encoder{site};
  const Bytes bytes = encoded(encoder, first.record);
  const auto again = SessionDecoder::decode(schema, bytes, at);
  PALP_CHECK(again.verdict == Verdict::Decoded && again.record.index() == first.record.index(),
             "what was decoded can be written and read");
  PALP_CHECK(encoded(encoder, again.record) == bytes, "what was decoded survives the file");
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
                             topics[*data / 2 % topics.size()].schema,
                             palp::fuzz::as_bytes(data, size).subspan(1));
  return 0;
}
