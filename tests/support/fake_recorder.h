#pragma once

#include <variant>
#include <vector>

#include "common/record/recorder.h"
#include "tests/support/realtime_guard.h"

namespace palp::test {

/// Keeps every record in the order of arrival. Growing is the test's business, not that of the
/// guarded code: a RealtimeGuard does not see it. Thread: its owner's.
class KeepingRecorder final : public record::Recorder {
 public:
  bool record(const Record& record) noexcept override {
    const RealtimeGuard::Pause pause;
    records_.push_back(record);
    return true;
  }

  [[nodiscard]] const std::vector<Record>& records() const noexcept { return records_; }
  void clear() noexcept { records_.clear(); }

  /// All records of one type, e.g. all<Transition>().
  template <class Type>
  [[nodiscard]] std::vector<Type> all() const {
    std::vector<Type> found;
    for (const Record& record : records_) {
      if (const auto* one = std::get_if<Type>(&record)) found.push_back(*one);
    }
    return found;
  }

 private:
  std::vector<Record> records_;
};

/// Takes every record and keeps none.
class NullRecorder final : public record::Recorder {
 public:
  bool record(const Record& /*record*/) noexcept override { return true; }
};

/// Refuses every record, as a full queue does.
class FullRecorder final : public record::Recorder {
 public:
  bool record(const Record& /*record*/) noexcept override { return false; }
};

}  // namespace palp::test
