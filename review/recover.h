#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "common/core/result.h"
#include "common/record/byte_sink.h"
#include "common/record/file_bytes.h"
#include "common/record/mcap_reader.h"

namespace palp::review {

struct TopicLoss {
  std::uint64_t messages{};    ///< missing in the topic's sequence
  std::uint64_t after{};       ///< [ns], log time of the last message before the first gap
  std::uint64_t disordered{};  ///< written again: twice there, or not in their order
};

/// What a recovery saved and what was lost.
struct Recovery {
  record::McapReadReport report;
  std::uint64_t messages{};                 ///< written again
  std::map<std::string, TopicLoss> losses;  ///< topics with a gap or a disorder
};

/// Whether there is anything to recover.
[[nodiscard]] bool holds_message(const record::FileBytes& file);

/// Writes all that can be read of `file` again, with index and summary.
[[nodiscard]] Result<Recovery> recover(const record::FileBytes& file, record::ByteSink& out);

/// For people.
[[nodiscard]] std::string describe(const Recovery& recovery);

}  // namespace palp::review
