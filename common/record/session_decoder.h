#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "common/record/recorder.h"

namespace palp::record {

/// The messages of proto/session_log.proto back to Records. Thread: one.
class SessionDecoder {
 public:
  SessionDecoder();
  ~SessionDecoder();
  SessionDecoder(const SessionDecoder&) = delete;
  SessionDecoder& operator=(const SessionDecoder&) = delete;

  enum class Verdict : std::uint8_t {
    Decoded,
    View,       ///< a sound view: derived, so there is no record of it
    Unknown,    ///< a schema of somebody else
    Malformed,  ///< bytes or values that no encoder of ours makes
  };
  struct Answer {
    Verdict verdict{};
    Record record;  ///< if decoded
  };
  Answer decode(std::string_view schema, std::span<const std::byte> payload, TimePoint at);

 private:
  struct Messages;
  std::unique_ptr<Messages> messages_;
};

}  // namespace palp::record
