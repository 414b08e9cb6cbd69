#include "surgeon_site/devices/register_reports.h"

#include <algorithm>
#include <utility>

namespace palp::surgeon {
namespace {

using io::PortFault;

constexpr std::size_t kAnswersMax = 16;  // a device that nobody listens to keeps no more

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t word) noexcept {
  const std::size_t at = 1 + 2 * word;
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

}  // namespace

RegisterReports::RegisterReports(std::unique_ptr<io::RegisterPort> registers,
                                 std::unique_ptr<io::ReportPort> pedal)
    : registers_{std::move(registers)}, pedal_{std::move(pedal)} {}

PortFault RegisterReports::open() {
  close();
  PortFault fault = registers_->open();
  if (fault == PortFault::None && pedal_->open() != PortFault::None) {
    fault = PortFault::PedalNotOpen;
  }
  if (fault != PortFault::None) close();
  return fault;
}

void RegisterReports::close() {
  registers_->close();
  pedal_->close();
  answers_.clear();
  lost_ = false;
}

PortFault RegisterReports::read(std::span<std::uint8_t> report,
                                std::size_t& length,
                                Duration /*wait*/) {
  length = 0;
  if (lost_) return PortFault::Lost;
  if (!answers_.empty()) {
    const Report& next = answers_.front();
    length = std::min(next.length, report.size());
    std::copy_n(next.bytes.begin(), length, report.begin());
    answers_.pop_front();
    return PortFault::None;
  }
  const PortFault fault = pedal_->read(report.subspan(1), length, Duration{0});
  if (fault != PortFault::None) return PortFault::PedalLost;
  if (length == 0) return fault;
  report[0] = kPedal;
  ++length;
  return PortFault::None;
}

PortFault RegisterReports::write(std::span<const std::uint8_t> report) {
  if (report.size() < 5 || report.size() % 2 == 0) return PortFault::Refused;
  std::array<std::uint16_t, 3 + kWordsMax> given{};
  const std::size_t count = (report.size() - 1) / 2;
  if (count > given.size()) return PortFault::Refused;
  for (std::size_t i = 0; i < count; ++i) given[i] = word_at(report, i);
  std::array<std::uint16_t, kWordsMax> words{};
  PortFault fault{PortFault::Refused};
  if (report[0] == kWrite) {
    const std::span<const std::uint16_t> written = std::span{given}.first(count).subspan(1);
    fault = written.size() == 1 ? registers_->write_one(given[0], written[0])
                                : registers_->write(given[0], written);
  } else if (report[0] == kRead && given[1] <= kWordsMax) {
    const auto read = std::span{words}.first(given[1]);
    fault = registers_->read(given[0], read, false);
    if (fault == PortFault::None) answer(kRead, given[0], read);
  } else if (report[0] == kExchange && count > 3 && given[2] <= kWordsMax) {
    const auto read = std::span{words}.first(given[2]);
    fault =
        registers_->exchange(given[0], std::span{given}.first(count).subspan(3), given[1], read);
    if (fault == PortFault::None) answer(kExchange, given[1], read);
  }
  lost_ = lost_ || fault == PortFault::Lost;
  return fault;
}

void RegisterReports::answer(Kind kind,
                             std::uint16_t address,
                             std::span<const std::uint16_t> words) {
  Report report;
  const auto put = [&](unsigned value) {
    report.bytes[report.length++] = static_cast<std::uint8_t>(value);
  };
  put(kind);
  put(address >> 8U);
  put(address & 0xFFU);
  for (const std::uint16_t word : words) {
    put(word >> 8U);
    put(word & 0xFFU);
  }
  if (answers_.size() >= kAnswersMax) answers_.pop_front();
  answers_.push_back(report);
}

PortFault RegisterReports::set_feature(std::span<const std::uint8_t> /*report*/) {
  return PortFault::Refused;
}

PortFault RegisterReports::get_feature(std::span<std::uint8_t> /*report*/, std::size_t& length) {
  length = 0;
  return PortFault::Refused;
}

}  // namespace palp::surgeon
