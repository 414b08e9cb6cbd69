#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "common/message/record.h"

namespace palp::record {

/// The messages of proto/session_log.proto back to Records. Thread: any.
class SessionDecoder {
 public:
  enum class Verdict : std::uint8_t {
    Decoded,
    View,       ///< derived, so there is no record of it
    Old,        ///< of files before protocol 4, and no record any more
    Unknown,    ///< a schema of somebody else
    Malformed,  ///< bytes or values that no encoder of ours makes
  };
  struct Answer {
    Verdict verdict{};
    Record record;  ///< if decoded
  };
  /// `schema`: full name of the message. `at`: the record's own instant.
  [[nodiscard]] static Answer decode(std::string_view schema,
                                     std::span<const std::byte> payload,
                                     TimePoint at) noexcept;
};

}  // namespace palp::record
