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
    Gathered,   ///< several records: scatter() gives them
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

  /// A tick's records in the order in which the site made them.
  class Parts {
   public:
    void clear() noexcept { size_ = taken_ = 0; }
    void add(const Record& record) noexcept { records_[size_++] = record; }
    /// nullopt: all were taken.
    std::optional<Record> take() noexcept {
      return taken_ < size_ ? std::optional{records_[taken_++]} : std::nullopt;
    }

   private:
    std::array<Record, 4> records_;
    std::size_t size_{};
    std::size_t taken_{};
  };
  /// Of a message that decode() calls gathered.
  static void scatter(std::string_view schema,
                      std::span<const std::byte> payload,
                      TimePoint at,
                      Parts& parts) noexcept;
};

}  // namespace palp::record
