#pragma once

#include <cstdint>
#include <optional>

#include "common/record/byte_sink.h"
#include "common/record/session_writer.h"
#include "lab/run/scenario.h"

namespace palp::lab {

/// Where the session files go; null: encoded and compressed all the same, then thrown away.
struct RunFiles {
  record::ByteSink* surgeon{};
  record::ByteSink* patient{};
};

/// The session files of both sites of a run, as the sites themselves would begin them; none of a
/// bare one. The time of virtual sessions begins with the year 2000 in UTC. Thread: the lab's.
class SessionFiles final {
 public:
  /// `start`: of the run, the lab's time.
  SessionFiles(const Scenario& scenario, const RunFiles& files, TimePoint start);

  [[nodiscard]] record::SessionWriter* surgeon() { return surgeon_ ? &*surgeon_ : nullptr; }
  [[nodiscard]] record::SessionWriter* patient() { return patient_ ? &*patient_ : nullptr; }
  [[nodiscard]] std::uint64_t records() const;  ///< in both
  void close();

 private:
  record::NullSink null_surgeon_;
  record::NullSink null_patient_;
  std::optional<record::SessionWriter> surgeon_;
  std::optional<record::SessionWriter> patient_;
};

}  // namespace palp::lab
