#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "common/record/recorder.h"
#include "common/record/session_encoder.h"

namespace palp::review {

/// Compares the records of a tick by the bytes that a session file would hold of them. A file gives
/// the samples that arrived at the tick's end, the site at its begin: their place says nothing.
class RecordComparison {
 public:
  explicit RecordComparison(link::Role site);

  /// `began_at`: of the run. @returns "topic, time, field: what it was and became" of the first
  /// difference; empty: there is none.
  [[nodiscard]] std::string compare(const std::vector<Record>& logged,
                                    const std::vector<Record>& again,
                                    TimePoint began_at);

 private:
  struct Encoded {
    std::string topic;
    TimePoint at{};
    std::vector<std::byte> bytes;  ///< topic and instant among them
  };
  Encoded encoded(const Record& record);
  [[nodiscard]] std::string field_of(const Record& logged, const Record& again) const;

  link::Role site_;
  record::SessionEncoder encoder_;
  std::array<std::string, record::kTopicCount> names_;
};

}  // namespace palp::review
