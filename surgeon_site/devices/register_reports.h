#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>

#include "common/io/device/report_port.h"

namespace palp::surgeon {

/// A device of registers as one that speaks in reports: an output report is a request, the next
/// input report its answer. Reports of a pedal, another device, come in between. Words have their
/// high byte first; the first byte of a report is its kind:
///   Write     address, words                                no answer
///   Read      address, count                                answer: kind, address, words
///   Exchange  write address, read address, count, words     answer: kind, read address, words
///   Pedal     only as input: kind, the pedal's report
/// Thread: its device's.
class RegisterReports final : public io::ReportPort {
 public:
  enum Kind : std::uint8_t { kWrite = 1, kRead = 2, kExchange = 3, kPedal = 4 };
  static constexpr std::size_t kBytesMax = 128;
  static constexpr std::size_t kWordsMax = 16;  ///< of a request, of an answer

  RegisterReports(std::unique_ptr<io::RegisterPort> registers,
                  std::unique_ptr<io::ReportPort> pedal);

  io::PortFault open() override;
  void close() override;
  io::PortFault read(std::span<std::uint8_t> report, std::size_t& length, Duration wait) override;
  /// Blocks for a transaction.
  io::PortFault write(std::span<const std::uint8_t> report) override;
  /// Refused: there are none.
  io::PortFault set_feature(std::span<const std::uint8_t> report) override;
  io::PortFault get_feature(std::span<std::uint8_t> report, std::size_t& length) override;

 private:
  struct Report {
    std::array<std::uint8_t, kBytesMax> bytes{};
    std::size_t length{};
  };
  void answer(Kind kind, std::uint16_t address, std::span<const std::uint16_t> words);

  std::unique_ptr<io::RegisterPort> registers_;
  std::unique_ptr<io::ReportPort> pedal_;
  std::deque<Report> answers_;
  bool lost_{};
};

}  // namespace palp::surgeon
