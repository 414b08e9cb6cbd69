// A one-axis haptic paddle on a Teensy (USB type "Raw HID"): an encoder, a motor driver with PWM
// and direction, an emergency stop, a pedal, a lamp. Reports at 1 kHz, and makes the force zero
// when the host's word has run out. Set the numbers below to your paddle; 0 N per count means not
// calibrated, and the host then gives no force.
#include "paddle_report.h"

#ifndef PADDLE_NANOMETRES_PER_COUNT
#define PADDLE_NANOMETRES_PER_COUNT 0  // from a ruler: handle's way over encoder counts
#endif
#ifndef PADDLE_DUTY_PER_NEWTON
#define PADDLE_DUTY_PER_NEWTON 0  // from a scale: PWM counts per newton at the handle
#endif

namespace {

constexpr double kNanometresPerCount = PADDLE_NANOMETRES_PER_COUNT;
constexpr double kDutyPerNewton = PADDLE_DUTY_PER_NEWTON;
constexpr int kDutyMost = 200;             // of 255
constexpr int kEncoderA = 2;
constexpr int kEncoderB = 3;
constexpr int kMotorPwm = 4;
constexpr int kMotorDirection = 5;
constexpr int kEmergencyStop = 6;  // normally closed to ground: open stops
constexpr int kPedal = 7;          // closed to ground: held
constexpr int kLamp = 13;
constexpr std::uint32_t kPeriodUs = 1000;

volatile std::int32_t counts = 0;
std::int32_t zero_counts = 0;
std::int32_t last_position_nm = 0;
double velocity_um_per_s = 0;
std::uint32_t next_us = 0;
std::uint32_t good_until_ms = 0;
palp_paddle::State state{};
palp_paddle::Command command{};
bool commanded = false;

void step_of_encoder() {
  counts = counts + (digitalRead(kEncoderA) == digitalRead(kEncoderB) ? 1 : -1);
}

void drive(double force_n) {
  double duty = force_n * kDutyPerNewton;
  digitalWrite(kMotorDirection, duty < 0 ? HIGH : LOW);
  if (duty < 0) duty = -duty;
  analogWrite(kMotorPwm, static_cast<int>(duty > kDutyMost ? kDutyMost : duty));
}

void hear() {
  std::uint8_t report[palp_paddle::kReportBytes];
  while (RawHID.recv(report, 0) > 0) {
    palp_paddle::Command heard{};
    if (!palp_paddle::unpack(report, sizeof report, heard)) {
      state.flags |= palp_paddle::kStateBadCommand;
      continue;
    }
    state.flags &= static_cast<std::uint16_t>(~palp_paddle::kStateBadCommand);
    command = heard;
    commanded = true;
    state.command_sequence = heard.sequence;
    good_until_ms = millis() + heard.valid_for_ms;
    if ((heard.flags & palp_paddle::kCommandZeroHere) != 0) zero_counts = counts;
  }
}

void set_flag(std::uint16_t flag, bool on) {
  state.flags = static_cast<std::uint16_t>(on ? state.flags | flag : state.flags & ~flag);
}

void push() {
  const bool stopped = digitalRead(kEmergencyStop) == HIGH;
  const bool calibrated = kDutyPerNewton != 0 && kNanometresPerCount != 0;
  // For good: the clock wraps, and in 25 days an old word would be in time again.
  if (static_cast<std::int32_t>(good_until_ms - millis()) <= 0) commanded = false;
  const bool expired = !commanded;
  const bool enabled =
      calibrated && !stopped && !expired && (command.flags & palp_paddle::kCommandEnable) != 0;
  drive(enabled ? command.force_un * 1e-6 : 0);
  set_flag(palp_paddle::kStateCalibrated, calibrated);
  set_flag(palp_paddle::kStateMotorEnabled, enabled);
  set_flag(palp_paddle::kStateEmergencyStop, stopped);
  set_flag(palp_paddle::kStateCommandExpired, expired);
  set_flag(palp_paddle::kStatePedalHeld, digitalRead(kPedal) == LOW);
  digitalWrite(kLamp, !expired && (command.flags & palp_paddle::kCommandLamp) != 0 ? HIGH : LOW);
}

void tell() {
  const double position_nm = (counts - zero_counts) * kNanometresPerCount;
  state.position_nm = static_cast<std::int32_t>(position_nm);
  const double step_um = (state.position_nm - last_position_nm) * 1e-3;
  last_position_nm = state.position_nm;
  velocity_um_per_s += 0.3 * (step_um * 1e6 / kPeriodUs - velocity_um_per_s);
  state.velocity_um_per_s = static_cast<std::int32_t>(velocity_um_per_s);
  state.time_us = micros();
  ++state.sequence;
  std::uint8_t report[palp_paddle::kReportBytes];
  palp_paddle::pack(state, report);
  RawHID.send(report, 0);
}

}  // namespace

void setup() {
  pinMode(kEncoderA, INPUT_PULLUP);
  pinMode(kEncoderB, INPUT_PULLUP);
  pinMode(kEmergencyStop, INPUT_PULLUP);
  pinMode(kPedal, INPUT_PULLUP);
  pinMode(kMotorPwm, OUTPUT);
  pinMode(kMotorDirection, OUTPUT);
  pinMode(kLamp, OUTPUT);
  drive(0);
  attachInterrupt(digitalPinToInterrupt(kEncoderA), step_of_encoder, CHANGE);
  next_us = micros();
}

void loop() {
  hear();
  push();
  if (static_cast<std::int32_t>(micros() - next_us) < 0) return;
  next_us += kPeriodUs;
  tell();
}
