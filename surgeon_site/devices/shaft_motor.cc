#include "surgeon_site/devices/shaft_motor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "surgeon_site/devices/register_reports.h"

namespace palp::surgeon {
namespace {

using io::PortFault;

// Registers; of values of 32 bits the low word comes first.
constexpr std::uint16_t kErrorsClear = 0;
constexpr std::uint16_t kModeCommand = 3;
constexpr std::uint16_t kForceCommand = 28;
constexpr std::uint16_t kForceCeiling = 140;
constexpr std::uint16_t kDriveWatchdog = 163;
constexpr std::uint16_t kModeNow = 317;
constexpr std::uint16_t kShaftState = ShaftMotor::kPlaceAt;  // place, speed, acceleration, force
constexpr std::uint16_t kShaftWords = 8;
constexpr std::uint16_t kErrors = 432;

constexpr std::uint16_t kClearErrors = 2;
constexpr std::uint16_t kSleep = 1;
constexpr std::uint16_t kForceControl = 2;
constexpr std::uint16_t kWatchdogMs = 50;       // [ms]
constexpr std::uint16_t kWatchdogBit = 0x0800;  // ends each lost line
constexpr std::uint32_t kStateEvery = 10;       // readings

struct ShaftError {
  std::uint16_t mask;
  std::string_view means;
};
// A force that the ceiling clips, b5, is none.
constexpr std::array<ShaftError, 7> kShaftErrors{{{0x0001, "its configuration is invalid"},
                                                  {0x0040, "it is too hot"},
                                                  {0x0080, "its force was exceeded"},
                                                  {0x0100, "its power was exceeded"},
                                                  {0x0200, "it does not see its shaft"},
                                                  {0x0400, "its voltage is invalid"},
                                                  {kWatchdogBit, "its watchdog has stopped it"}}};

std::string_view shaft_trouble(std::uint16_t errors) noexcept {
  for (const ShaftError& one : kShaftErrors) {
    if ((errors & one.mask) != 0) return one.means;
  }
  return {};
}

std::uint16_t low_word(std::int32_t value) noexcept {
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(value) & 0xFFFFU);
}

std::uint16_t high_word(std::int32_t value) noexcept {
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(value) >> 16U);
}

std::uint16_t word_of(std::span<const std::uint8_t> report, std::size_t word) noexcept {
  const std::size_t at = 1 + 2 * word;
  return static_cast<std::uint16_t>((report[at] << 8U) | report[at + 1]);
}

}  // namespace

PortFault ShaftMotor::ask(io::ReportPort& port,
                          std::uint8_t kind,
                          std::initializer_list<std::uint16_t> words) {
  std::array<std::uint8_t, RegisterReports::kBytesMax> report{kind};
  std::size_t length = 1;
  for (const std::uint16_t word : words) {
    report[length++] = static_cast<std::uint8_t>(word >> 8U);
    report[length++] = static_cast<std::uint8_t>(word & 0xFFU);
  }
  return port.write(std::span{report}.first(length));
}

Duration ShaftMotor::time_of_exchange(const io::ModbusAddress& line) noexcept {
  constexpr double kBits = 38 * 11;  // 38 bytes with parity
  return line.line.empty() ? kReplyDelay : from_seconds(kBits / line.baud);
}

void ShaftMotor::begin(bool asked) noexcept {
  step_ = Step::Sleep;
  asked_ = asked;
  errors_known_ = mode_known_ = place_known_ = false;
  sent_ = 0;
}

// One request a cycle, so that no step holds up the readings.
StartOutcome ShaftMotor::start(io::ReportPort& port, TimePoint /*now*/, std::string_view& why) {
  const auto ceiling = static_cast<std::int32_t>(std::lround(force_max_ / kForceUnit));
  PortFault fault{};
  Step next = step_;
  switch (step_) {
    case Step::Sleep:
      fault = ask(port, RegisterReports::kWrite, {kModeCommand, kSleep});
      next = Step::Look;
      break;
    case Step::Look:
      if (!errors_known_) break;
      // Who comes back by itself clears what a lost line has done, and nothing else.
      why = shaft_trouble(static_cast<std::uint16_t>(errors_ & ~kWatchdogBit));
      if (!asked_ && !why.empty()) return StartOutcome::Failed;
      next = Step::Clear;
      break;
    case Step::Clear:
      fault = ask(port, RegisterReports::kWrite, {kErrorsClear, kClearErrors});
      next = Step::Watchdog;
      break;
    case Step::Watchdog:
      fault = ask(port, RegisterReports::kWrite, {kDriveWatchdog, kWatchdogMs});
      next = Step::Ceiling;
      break;
    case Step::Ceiling:
      fault = ask(
          port, RegisterReports::kWrite, {kForceCeiling, low_word(ceiling), high_word(ceiling)});
      next = Step::Mode;
      break;
    case Step::Mode:
      fault = ask(port, RegisterReports::kWrite, {kModeCommand, kForceControl});
      errors_known_ = mode_known_ = false;
      sent_ = 0;
      next = Step::Wait;
      break;
    case Step::Wait:
      if (errors_known_ && mode_known_ && place_known_) next = Step::Done;
      break;
    case Step::Done:
      return StartOutcome::Done;
  }
  if (fault == PortFault::Refused) {
    why = "a request of its start was refused";
    return StartOutcome::Failed;
  }
  if (fault == PortFault::None) step_ = next;  // else once more
  return StartOutcome::Going;
}

Taken ShaftMotor::take(std::span<const std::uint8_t> report,
                       TimePoint /*now*/,
                       MasterSample& sample) {
  if (report.empty()) return Taken::Unknown;
  if (report[0] == RegisterReports::kPedal) {
    if (report.size() <= 1 + pedal_.byte) return Taken::Unknown;
    sample.pedal_held = (report[1 + pedal_.byte] & pedal_.mask) != 0;
    sample.answers_held = answers_.held(report.subspan(1));
    return Taken::Aside;
  }
  if (report.size() < 5) return Taken::Unknown;
  const std::uint16_t address = word_of(report, 0);
  Taken taken{Taken::Aside};
  if (address == kErrors) {
    errors_ = word_of(report, 1);
    errors_known_ = true;
  } else if (address == kModeNow) {
    mode_ = word_of(report, 1);
    mode_known_ = true;
  } else if (address == kShaftState && report.size() == 3 + 2 * kShaftWords) {
    const std::uint32_t place = word_of(report, 1) | (std::uint32_t{word_of(report, 2)} << 16U);
    sample.position = static_cast<std::int32_t>(place);
    place_known_ = true;
    taken = Taken::Reading;
  } else {
    return Taken::Unknown;
  }
  sample.trouble = shaft_trouble(errors_);
  if (sample.trouble.empty() && step_ == Step::Done && mode_ != kForceControl) {
    sample.trouble = "it has left the control of its force";
  }
  return taken;
}

PortFault ShaftMotor::send(io::ReportPort& port, double force, bool live, TimePoint /*now*/) {
  const double most = force_max_ / kForceUnit;
  const auto counts =
      static_cast<std::int32_t>(std::lround(live ? std::clamp(force, -most, most) : 0));
  const PortFault fault =
      ask(port,
          RegisterReports::kExchange,
          {kForceCommand, kShaftState, kShaftWords, low_word(counts), high_word(counts)});
  if (fault != PortFault::None) return fault;
  const std::uint32_t turn = sent_++ % kStateEvery;
  if (turn == 0) return ask(port, RegisterReports::kRead, {kErrors, 1});
  if (turn == 1) return ask(port, RegisterReports::kRead, {kModeNow, 1});
  return fault;
}

void ShaftMotor::stop(io::ReportPort& port) {
  (void)ask(port, RegisterReports::kWrite, {kForceCommand, 0, 0});
  (void)ask(port, RegisterReports::kWrite, {kModeCommand, kSleep});
}

}  // namespace palp::surgeon
