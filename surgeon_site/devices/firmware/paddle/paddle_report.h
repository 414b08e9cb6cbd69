#pragma once

#include <cstddef>
#include <cstdint>

/// Reports between a paddle's firmware and its host, version 1: 64 bytes each way, little-endian,
/// no report id. The firmware compiles this header too, so it asks for no more than C++11.
///
///   offset  state, device to host             command, host to device
///   0       0x50 0x50                         the same
///   2       version 1                         the same
///   3       kind 1                            kind 2
///   4  u16  sequence                          sequence
///   6  u16  flags, kState...                  flags, kCommand...
///   8  u32  device's time [us]                host's time [us], for the record
///   12 i32  position [nm], + into the tissue  force [uN], + pushes the hand out
///   16      i32 velocity [um/s]               u16 valid for [ms]; 0: zero force now
///   20 i16  motor current [mA]                0
///   22 u16  sequence of the last good command 0
///   24-61   0                                 0
///   62 u16  CRC-16 of bytes 0 to 61           the same
///
/// The CRC has polynomial 0x1021, start 0xFFFF, no reflection. The firmware makes the force zero
/// when a command's time has passed and no good one came.
namespace palp_paddle {

constexpr std::size_t kReportBytes = 64;
constexpr std::size_t kCrcAt = 62;
constexpr std::uint16_t kVendor = 0x16C0;
constexpr std::uint16_t kProduct = 0x0486;
constexpr std::uint16_t kUsagePage = 0xFFAB;

constexpr std::uint16_t kStateCalibrated = 1;
constexpr std::uint16_t kStateMotorEnabled = 2;
constexpr std::uint16_t kStateEmergencyStop = 4;
constexpr std::uint16_t kStateTooHot = 8;
constexpr std::uint16_t kStateCommandExpired = 16;
constexpr std::uint16_t kStateBadCommand = 32;
constexpr std::uint16_t kStatePedalHeld = 64;

constexpr std::uint16_t kCommandEnable = 1;
constexpr std::uint16_t kCommandZeroHere = 2;
constexpr std::uint16_t kCommandLamp = 4;  ///< the session is engaged

struct State {
  std::uint16_t sequence;
  std::uint16_t flags;
  std::uint32_t time_us;
  std::int32_t position_nm;
  std::int32_t velocity_um_per_s;
  std::int16_t current_ma;
  std::uint16_t command_sequence;
};

struct Command {
  std::uint16_t sequence;
  std::uint16_t flags;
  std::uint32_t time_us;
  std::int32_t force_un;
  std::uint16_t valid_for_ms;
};

inline std::uint16_t crc(const std::uint8_t* bytes, std::size_t count) {
  std::uint32_t value = 0xFFFF;
  for (std::size_t i = 0; i < count; ++i) {
    value ^= static_cast<std::uint32_t>(bytes[i]) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      value = ((value & 0x8000U) != 0 ? (value << 1U) ^ 0x1021U : value << 1U) & 0xFFFFU;
    }
  }
  return static_cast<std::uint16_t>(value);
}

inline void put(std::uint8_t* at, std::uint32_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    at[i] = static_cast<std::uint8_t>((value >> (8U * i)) & 0xFFU);
  }
}

inline std::uint32_t take(const std::uint8_t* at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(at[i]) << (8U * i);
  return value;
}

inline std::uint16_t take_word(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(take(at, 2));
}

inline void begin(std::uint8_t* report,
                  std::uint8_t kind,
                  std::uint16_t sequence,
                  std::uint16_t flags) {
  for (std::size_t i = 0; i < kReportBytes; ++i) report[i] = 0;
  report[0] = report[1] = 0x50;
  report[2] = 1;
  report[3] = kind;
  put(report + 4, sequence, 2);
  put(report + 6, flags, 2);
}

inline void end(std::uint8_t* report) { put(report + kCrcAt, crc(report, kCrcAt), 2); }

/// Whole, of this version and kind.
inline bool is_report(const std::uint8_t* report, std::size_t count, std::uint8_t kind) {
  return count == kReportBytes && report[0] == 0x50 && report[1] == 0x50 && report[2] == 1 &&
         report[3] == kind && take_word(report + kCrcAt) == crc(report, kCrcAt);
}

inline void pack(const State& state, std::uint8_t* report) {
  begin(report, 1, state.sequence, state.flags);
  put(report + 8, state.time_us, 4);
  put(report + 12, static_cast<std::uint32_t>(state.position_nm), 4);
  put(report + 16, static_cast<std::uint32_t>(state.velocity_um_per_s), 4);
  put(report + 20, static_cast<std::uint16_t>(state.current_ma), 2);
  put(report + 22, state.command_sequence, 2);
  end(report);
}

inline bool unpack(const std::uint8_t* report, std::size_t count, State& state) {
  if (!is_report(report, count, 1)) return false;
  state.sequence = take_word(report + 4);
  state.flags = take_word(report + 6);
  state.time_us = take(report + 8, 4);
  state.position_nm = static_cast<std::int32_t>(take(report + 12, 4));
  state.velocity_um_per_s = static_cast<std::int32_t>(take(report + 16, 4));
  state.current_ma = static_cast<std::int16_t>(take_word(report + 20));
  state.command_sequence = take_word(report + 22);
  return true;
}

inline void pack(const Command& command, std::uint8_t* report) {
  begin(report, 2, command.sequence, command.flags);
  put(report + 8, command.time_us, 4);
  put(report + 12, static_cast<std::uint32_t>(command.force_un), 4);
  put(report + 16, command.valid_for_ms, 2);
  end(report);
}

inline bool unpack(const std::uint8_t* report, std::size_t count, Command& command) {
  if (!is_report(report, count, 2)) return false;
  command.sequence = take_word(report + 4);
  command.flags = take_word(report + 6);
  command.time_us = take(report + 8, 4);
  command.force_un = static_cast<std::int32_t>(take(report + 12, 4));
  command.valid_for_ms = take_word(report + 16);
  return true;
}

}  // namespace palp_paddle
