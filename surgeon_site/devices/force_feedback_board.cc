#include "surgeon_site/devices/force_feedback_board.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palp::surgeon {
namespace {

using io::PortFault;

constexpr std::uint16_t kBoardVendor = 0x1209;
constexpr std::uint16_t kBoardProduct = 0xFFB0;
constexpr int kBoardInterface = 2;

// Reports by id; lengths with it.
constexpr std::uint8_t kAxesReport = 0x01;
constexpr std::uint8_t kStateReport = 0x02;
constexpr std::size_t kButtonBytes = 8;
constexpr std::size_t kAxesBytes = 25;  // with axes of 16 bits
constexpr std::size_t kAxisAt = 9;
constexpr std::size_t kAxesMost = 8;
constexpr std::uint8_t kLoadReport = 0x12;
constexpr std::size_t kLoadBytes = 5;
constexpr std::uint8_t kLoadGood = 1;
constexpr std::uint8_t kLoadFull = 2;

// Of the state: bits.
constexpr unsigned kPaused = 1U;
constexpr unsigned kActuatorsOn = 2U;
constexpr unsigned kSafetySwitch = 4U;
constexpr unsigned kActuatorPower = 8U;

constexpr std::array<std::uint8_t, 2> kReset{0x0C, 0x08};
constexpr std::array<std::uint8_t, 2> kEnable{0x0C, 0x01};
constexpr std::array<std::uint8_t, 2> kDisable{0x0C, 0x02};
constexpr std::array<std::uint8_t, 2> kStopAll{0x0C, 0x04};
constexpr std::array<std::uint8_t, 2> kFullGain{0x0D, 0xFF};
constexpr std::array<std::uint8_t, 4> kNewConstant{0x11, 0x01, 0x00, 0x00};

// Asks for the position of the axis. What its own protocol answers is only a sign of life.
constexpr std::uint8_t kVendorReport = 0xA1;
constexpr std::array<std::uint8_t, 25> kWhereIsTheAxis{kVendorReport, 0x01, 0x01, 0x0A, 0x00, 0x0E};

constexpr Duration kEffectAgain = std::chrono::milliseconds{40};  // of its 100 ms
constexpr int kResetsMax = 3;
constexpr double kForceCountsMax = 32'767;

std::string_view board_trouble(unsigned state) noexcept {
  if ((state & kActuatorPower) == 0) return "the actuator has no power";
  if ((state & kSafetySwitch) == 0) return "emergency stop";
  if ((state & kPaused) != 0) return "its effects are paused";
  if ((state & kActuatorsOn) == 0) return "its actuators are switched off";
  return {};
}

std::int32_t signed_at(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value |= static_cast<std::uint32_t>(bytes[at + i]) << (8U * i);
  }
  return count == 2 ? static_cast<std::int16_t>(value) : static_cast<std::int32_t>(value);
}

}  // namespace

io::HidAddress ForceFeedbackBoard::address() {
  return {.vendor = kBoardVendor,
          .product = kBoardProduct,
          .interface_number = kBoardInterface,
          .usage_page = 0,
          .serial = {}};
}

void ForceFeedbackBoard::begin(bool /*asked*/) noexcept {
  step_ = Step::Reset;
  resets_ = 0;
  block_ = 0;
  state_known_ = axes_known_ = false;
}

// One request a cycle, so that no step holds up the reports.
StartOutcome ForceFeedbackBoard::start(io::ReportPort& port, TimePoint now, std::string_view& why) {
  PortFault fault{};
  switch (step_) {
    case Step::Reset:
      fault = port.write(kReset);
      step_ = Step::Enable;
      break;
    case Step::Enable:
      fault = port.write(kEnable);
      step_ = Step::Gain;
      break;
    case Step::Gain:
      fault = port.write(kFullGain);
      step_ = Step::Create;
      break;
    case Step::Create:
      fault = port.set_feature(kNewConstant);
      step_ = Step::Load;
      break;
    case Step::Load:
      return load(port, why);
    case Step::Set:
      fault = set_effect(port);
      step_ = Step::Start;
      break;
    case Step::Start:
      fault = start_effect(port, now);
      step_ = Step::Ask;
      break;
    case Step::Ask:  // a handle that stands still might not report for a while
      fault = port.write(kWhereIsTheAxis);
      step_ = Step::Wait;
      break;
    case Step::Wait:
      if (state_known_ && axes_known_) step_ = Step::Done;
      break;
    case Step::Done:
      return StartOutcome::Done;
  }
  if (fault == PortFault::None) return StartOutcome::Going;
  why = "a request of its start was refused";
  return StartOutcome::Failed;
}

StartOutcome ForceFeedbackBoard::load(io::ReportPort& port, std::string_view& why) {
  std::array<std::uint8_t, kLoadBytes> report{kLoadReport};
  std::size_t length{};
  const PortFault fault = port.get_feature(report, length);
  if (fault != PortFault::None || length < 3 || report[0] != kLoadReport) {
    why = "it does not say where its effect is";
    return StartOutcome::Failed;
  }
  if (report[2] == kLoadFull && ++resets_ < kResetsMax) {
    step_ = Step::Reset;
    return StartOutcome::Going;
  }
  if (report[2] != kLoadGood || report[1] == 0) {
    why = report[2] == kLoadFull ? "its effect pool is full, also after a reset: another program "
                                   "uses it"
                                 : "it could not make an effect";
    return StartOutcome::Failed;
  }
  block_ = report[1];
  step_ = Step::Set;
  return StartOutcome::Going;
}

PortFault ForceFeedbackBoard::set_effect(io::ReportPort& port) const {
  // Constant, 100 ms, no repeat, no sample period, no delay, full gain, no trigger, along direction
  // 90 degrees, whose sine is 1.
  const std::array<std::uint8_t, 18> report{
      0x01, block_, 0x01, 0x64, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 3, 0x28, 0x23, 0x00, 0x00};
  return port.write(report);
}

PortFault ForceFeedbackBoard::start_effect(io::ReportPort& port, TimePoint now) {
  const std::array<std::uint8_t, 4> report{0x0A, block_, 0x01, 0x01};
  effect_at_ = now;
  return port.write(report);
}

Taken ForceFeedbackBoard::take(std::span<const std::uint8_t> report,
                               TimePoint /*now*/,
                               MasterSample& sample) {
  if (report.size() == 2 && report[0] == kStateReport) {
    state_known_ = true;
    sample.trouble = board_trouble(report[1]);
    sample.emergency_stop = (report[1] & kSafetySwitch) == 0;
    return Taken::Reading;
  }
  if (report.size() == kWhereIsTheAxis.size() && report[0] == kVendorReport) return Taken::Reading;
  const bool axes = report.size() >= kAxesBytes && (report.size() - kAxesBytes) % 2 == 0 &&
                    report.size() <= kAxesBytes + 2 * kAxesMost && report[0] == kAxesReport;
  if (!axes) return Taken::Unknown;
  axes_known_ = true;
  // A build with main axes of 32 bits is longer by 2 bytes for each, the first of them first.
  const bool wide = report.size() > kAxesBytes;
  sample.position = signed_at(report, kAxisAt, wide ? 4 : 2);
  if (wide) sample.position /= 65'536;
  const auto button = static_cast<std::size_t>(pedal_button_);
  sample.pedal_held = ((report[1 + button / 8] >> (button % 8)) & 1U) != 0;
  sample.answers_held = answers_.held(report.subspan(1, kButtonBytes));
  return Taken::Reading;
}

PortFault ForceFeedbackBoard::send(io::ReportPort& port, double force, bool live, TimePoint now) {
  if (block_ == 0 || step_ != Step::Done) return PortFault::None;
  const auto counts = static_cast<std::uint16_t>(static_cast<std::int16_t>(
      std::lround(live ? std::clamp(force, -kForceCountsMax, kForceCountsMax) : 0)));
  const std::array<std::uint8_t, 4> report{0x05,
                                           block_,
                                           static_cast<std::uint8_t>(counts & 0xFFU),
                                           static_cast<std::uint8_t>(counts >> 8U)};
  const PortFault fault = port.write(report);
  // Nobody asks for force any more: the effect is left to end.
  if (fault != PortFault::None || !live || now - effect_at_ < kEffectAgain) return fault;
  return start_effect(port, now);
}

void ForceFeedbackBoard::stop(io::ReportPort& port) {
  if (block_ != 0) {
    (void)port.write(std::array<std::uint8_t, 4>{0x05, block_, 0, 0});
  }
  (void)port.write(kStopAll);
  (void)port.write(kDisable);
}

}  // namespace palp::surgeon
