#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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
    Old,        ///< of older files, and no record any more
    Unknown,    ///< a schema of somebody else
    Malformed,  ///< bytes or values that no encoder of ours makes
  };

  /// The records of a message, in the order in which the site made them.
  class Parts {
   public:
    void clear() noexcept { size_ = taken_ = 0; }
    void add(const Record& record) noexcept { records_[size_++] = record; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// nullopt: all were taken.
    std::optional<Record> take() noexcept {
      return taken_ < size_ ? std::optional{records_[taken_++]} : std::nullopt;
    }

   private:
    std::array<Record, 6> records_;
    std::size_t size_{};
    std::size_t taken_{};
  };

  /// `schema`: full name of the message. `at`: its records' own instant. Into `parts` come its
  /// records; none, if it is not decoded.
  static Verdict decode(std::string_view schema,
                        std::span<const std::byte> payload,
                        TimePoint at,
                        Parts& parts) noexcept;
};

}  // namespace palp::record
