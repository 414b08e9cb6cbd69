#pragma once

#include <cstdint>
#include <vector>

#include "common/record/session_writer.h"
#include "tests/common/message/same.h"

/// Builders and comparisons for the tests of this room.
namespace palp::record::test {

inline TimePoint at_ms(std::int64_t value) { return TimePoint{std::chrono::milliseconds{value}}; }

inline SiteTick tick(std::int64_t ms) {
  return {.at = at_ms(ms),
          .state = SiteState::Engaged,
          .epoch = 3,
          .position = 1e-3 * static_cast<double>(ms % 7),
          .velocity = -0.02,
          .force = 0.25,
          .place = {.x = 0.01, .y = -0.02},
          .command = 0.125,
          .gate_acted = ms % 5 == 0,
          .round_trip = Duration{12345678},
          .sent = {.position = 1e-3, .velocity = 0.5, .force = 0.25, .payload = {}}};
}

/// Every field of a record, bit for bit: two records are the same if these are.
inline message::Words fields(const Record& record) { return message::words_of(record); }

/// A patient's file of `ticks` ticks with notes and one estimate, in chunks of `chunk_ms`.
inline std::vector<std::byte> small_session(int ticks, int chunk_ms) {
  MemorySink sink;
  McapOptions options;
  options.chunk_span_max = std::chrono::milliseconds{chunk_ms};
  SessionWriter writer{sink,
                       {.site = link::Role::Patient,
                        .metadata = {{"seed", "7"}},
                        .attachments = {{"tissue.csv", "text/csv", "site,d_mm,F_N\nA,0,0\n"}}},
                       options};
  for (int k = 0; k < ticks; ++k) {
    writer.write(tick(k));
    if (k % 10 == 3) {
      writer.write(Note{.at = at_ms(k), .code = 33, .detail = 1.5});
    }
  }
  writer.write(DepthEstimate{.number = 1, .stroke_ended_at = at_ms(ticks), .place = {}});
  writer.close();
  return {sink.bytes().begin(), sink.bytes().end()};
}

}  // namespace palp::record::test
