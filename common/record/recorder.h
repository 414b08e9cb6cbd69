#pragma once

#include "common/message/record.h"

/// What a site writes down. Safe to write from rt: a Recorder only copies.
namespace palp::record {

/// Thread: rt. Never blocks, never allocates.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// @returns false: queue full, the record is lost and counted.
  virtual bool record(const Record& record) noexcept = 0;
};

}  // namespace palp::record
