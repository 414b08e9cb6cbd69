#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace palp::io {

/// What became of a transaction.
enum class PortFault : std::uint8_t {
  None,
  NotOpen,       ///< cannot be opened: nobody there, no permission
  Ambiguous,     ///< more than one is there that agrees: which is meant, nobody said
  Lost,          ///< was open and is gone: unplugged, connection closed
  NoReply,       ///< within the time that baud rate, lengths and the device's delay allow
  BrokenFrame,   ///< checksum, length or function are not those of the answer
  WrongStation,  ///< another device answered
  Refused,       ///< an exception of the device: it knows no such register, or not now
  PedalNotOpen,  ///< of a device with a pedal of its own: that one cannot be opened
  PedalLost      ///< was there, and is gone
};

[[nodiscard]] constexpr std::string_view to_string(PortFault fault) noexcept {
  switch (fault) {
    case PortFault::None:
      return "";
    case PortFault::NotOpen:
      return "cannot be opened";
    case PortFault::Ambiguous:
      return "more than one is there: unplug one, or give its serial";
    case PortFault::Lost:
      return "connection lost";
    case PortFault::NoReply:
      return "no reply";
    case PortFault::BrokenFrame:
      return "broken frame";
    case PortFault::WrongStation:
      return "another station answered";
    case PortFault::Refused:
      return "request refused";
    case PortFault::PedalNotOpen:
      return "its pedal cannot be opened";
    case PortFault::PedalLost:
      return "its pedal is gone";
  }
  return "?";
}

/// Registers of one device behind a line: 16-bit words at 16-bit addresses. Calls block for as long
/// as a transaction takes. Thread: its device's.
class RegisterPort {
 public:
  virtual ~RegisterPort() = default;
  virtual PortFault open() = 0;
  virtual void close() = 0;  ///< idempotent
  /// 1 to 125 words from `address` on; `input`: of the read-only table (function 4, not 3).
  virtual PortFault read(std::uint16_t address, std::span<std::uint16_t> words, bool input) = 0;
  /// Function 16, 1 to 123 words.
  virtual PortFault write(std::uint16_t address, std::span<const std::uint16_t> words) = 0;
  virtual PortFault write_one(std::uint16_t address, std::uint16_t word) = 0;  ///< function 6
  virtual PortFault write_coil(std::uint16_t address, bool on) = 0;            ///< function 5
  /// Function 23: writes 1 to 121 words, then reads, in one transaction.
  virtual PortFault exchange(std::uint16_t write_address,
                             std::span<const std::uint16_t> written,
                             std::uint16_t read_address,
                             std::span<std::uint16_t> words) = 0;
};

}  // namespace palp::io
