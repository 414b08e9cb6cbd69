#pragma once

#include "common/record/recorder.h"
#include "lab/run/digest.h"

namespace palp::lab {

/// A recorder that folds everything a node says into a digest, and passes it on. Thread: the lab's.
class DigestRecorder final : public record::Recorder {
 public:
  /// `next` may be null; both outlive the recorder.
  DigestRecorder(Digest& digest, record::Recorder* next) noexcept : digest_{digest}, next_{next} {}
  bool record(const Record& record) noexcept override;

 private:
  Digest& digest_;
  record::Recorder* next_;
};

}  // namespace palp::lab
