#include "surgeon_site/devices/master_device.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace palp::surgeon {
namespace {

using io::PortFault;

constexpr Duration kReopenPause = std::chrono::milliseconds{500};
constexpr Duration kHealthWait = std::chrono::seconds{1};  // after the last step of the start
constexpr int kReportsMax = 4096;                          // of one cycle; no kernel keeps more
constexpr std::size_t kReportBytesMax = 128;
constexpr Duration kUnsentMax = std::chrono::milliseconds{100};

}  // namespace

std::string_view to_string(MasterState state) noexcept {
  switch (state) {
    case MasterState::Absent:
      return "absent";
    case MasterState::Starting:
      return "starting";
    case MasterState::Ready:
      return "ready";
    case MasterState::Fault:
      return "fault";
  }
  return "?";
}

MasterDevice::MasterDevice(std::unique_ptr<MasterProtocol> protocol,
                           const MasterInstallation& installation,
                           io::ReportPort& port)
    : protocol_{std::move(protocol)},
      installation_{installation},
      port_{port},
      jumps_{installation.speed_max} {}

MasterReading MasterDevice::cycle(const Clock& clock, const MasterCommand& command) {
  const TimePoint now = clock.now();
  if (std::exchange(restarts_, command.restarts) != command.restarts &&
      now_.state == MasterState::Fault) {
    held_ = {};
    asked_ = true;
    enter_start();
  }
  if (now_.state == MasterState::Absent) reach(now);
  if (now_.state == MasterState::Absent) return now_;
  protocol_->show_lamp(command.engaged);
  const bool sent = protocol_->answers() && now_.state == MasterState::Ready;
  if (sent) send(command, clock.now());
  if (now_.state != MasterState::Absent) drain(clock);
  if (now_.state == MasterState::Starting) proceed(clock.now());
  // A fault that was just seen takes the force away at once.
  const bool again = !sent || now_.state != MasterState::Ready;
  if (again && now_.state != MasterState::Absent) send(command, clock.now());
  return now_;
}

void MasterDevice::stop() {
  if (now_.state != MasterState::Absent) protocol_->stop(port_);
}

void MasterDevice::reach(TimePoint now) {
  if (tried_ && now < reopen_at_) return;
  tried_ = true;
  reopen_at_ = now + kReopenPause;
  const PortFault fault = port_.open();
  if (fault != PortFault::None) {
    now_.why = io::to_string(fault);
    return;
  }
  heard_at_ = reached_at_ = now;
  enter_start();
  if (!held_.empty()) fail(held_);  // no cable frees it of its fault
}

void MasterDevice::enter_start() noexcept {
  now_.state = MasterState::Starting;
  now_.why = {};
  now_.velocity = 0;
  start_done_ = position_known_ = sequence_known_ = false;
  sample_ = {};
  jumps_.reset();
  protocol_->begin(asked_);
}

void MasterDevice::drain(const Clock& clock) {
  std::array<std::uint8_t, kReportBytesMax> bytes{};
  int good = 0;
  for (int i = 0; i < kReportsMax; ++i) {
    std::size_t length = 0;
    const PortFault fault = port_.read(bytes, length, Duration{0});
    if (fault != PortFault::None) return vanish(io::to_string(fault), clock.now());
    if (length == 0) break;
    const Taken taken = protocol_->take(std::span{bytes}.first(length), clock.now(), sample_);
    if (taken == Taken::Unknown) ++now_.broken;
    if (taken != Taken::Reading) continue;
    if (sample_.sequence_known) {
      if (sequence_known_ && sample_.sequence == sequence_) {
        ++now_.broken;  // one that was there already tells of no life
        continue;
      }
      if (sequence_known_) {
        now_.lost += static_cast<std::uint16_t>(sample_.sequence - sequence_ - 1);
      }
      sequence_ = sample_.sequence;
      sequence_known_ = true;
    }
    ++good;
  }
  const TimePoint now = clock.now();
  if (good > 0) {
    heard_at_ = now_.sampled_at = now;
    now_.number += static_cast<std::uint64_t>(good);
    now_.skipped += static_cast<std::uint64_t>(good - 1);
  } else if (installation_.silence > Duration{0} && now - heard_at_ > installation_.silence) {
    vanish("it fell silent", now);
    return;
  }
  const bool whole = protocol_->advance(now, sample_);
  now_.looked_at = now;
  if (good > 0 || position_known_ || whole) adopt(now);
}

/// A press counts, not how long it lasts.
void MasterDevice::hear_answers() noexcept {
  const unsigned before = std::exchange(answers_held_, sample_.answers_held);
  const unsigned pressed = sample_.answers_held & ~before;
  if (pressed == 0) return;
  now_.answer = static_cast<std::uint32_t>(std::countr_zero(pressed)) + 1;
  ++now_.answers;
}

void MasterDevice::adopt(TimePoint now) {
  hear_answers();
  now_.pedal_held = sample_.pedal_held;
  now_.emergency_stop = sample_.emergency_stop;
  now_.place = sample_.place;
  const double sign = installation_.reversed ? -1 : 1;
  const double position =
      (sample_.position * installation_.position_unit - installation_.zero) * sign;
  const double velocity = sample_.velocity * installation_.position_unit * sign;
  if (!std::isfinite(position) || !std::isfinite(velocity)) return fail("a reading is no number");
  const double span = seconds(now - std::exchange(stepped_at_, now));
  const double way = position - now_.position;
  const bool ready = now_.state == MasterState::Ready;
  if (ready && position_known_ && jumps_.jumped(way, span)) return fail("the position jumped");
  if (ready && (position < installation_.travel_min || position > installation_.travel_max)) {
    return fail("the position is outside its travel");
  }
  if (sample_.velocity_known) {
    now_.velocity = std::clamp(velocity, -installation_.speed_max, installation_.speed_max);
  } else {
    derive_velocity(position_known_ ? way : 0, span);
  }
  now_.position = position;
  position_known_ = true;
  if (ready && !sample_.trouble.empty()) fail(sample_.trouble);
}

void MasterDevice::derive_velocity(double way, double span) noexcept {
  if (span <= 0) return;
  const double share = 1 - std::exp(-2 * std::numbers::pi * installation_.velocity_pole * span);
  const double fastest = installation_.speed_max;  // what is faster is no hand
  now_.velocity += share * (std::clamp(way / span, -fastest, fastest) - now_.velocity);
}

void MasterDevice::proceed(TimePoint now) {
  if (!start_done_) {
    std::string_view why;
    const StartOutcome outcome = protocol_->start(port_, now, why);
    if (outcome == StartOutcome::Failed) return fail(why);
    if (outcome == StartOutcome::Going) return;
    start_done_ = true;
    started_at_ = now;
  }
  const bool outside =
      now_.position < installation_.travel_min || now_.position > installation_.travel_max;
  if (position_known_ && sample_.trouble.empty() && !outside) {
    now_.state = MasterState::Ready;
    asked_ = false;
    ++now_.starts;
    return;
  }
  if (!position_known_ || now - started_at_ <= kHealthWait) return;
  fail(outside ? "the position is outside its travel" : sample_.trouble);
}

void MasterDevice::send(const MasterCommand& command, TimePoint now) {
  const bool valid = now_.state == MasterState::Ready && now <= command.valid_until &&
                     std::isfinite(command.force) && installation_.force_unit > 0;
  now_.force =
      valid ? std::clamp(command.force, -installation_.force_max, installation_.force_max) : 0;
  const double sign = installation_.force_reversed ? -1 : 1;
  const double counts = valid ? sign * now_.force / installation_.force_unit : 0;
  if (protocol_->send(port_, counts, valid, now) == PortFault::None) {
    reached_at_ = now;
    return;
  }
  ++now_.unsent;
  if (now - reached_at_ > kUnsentMax) vanish("commands do not reach it", now);
}

void MasterDevice::vanish(std::string_view why, TimePoint now) {
  protocol_->stop(port_);  // a device that is only silent may still hear
  port_.close();
  now_.state = MasterState::Absent;
  now_.why = why;
  now_.velocity = now_.force = 0;
  now_.pedal_held = false;
  reopen_at_ = now + kReopenPause;
}

void MasterDevice::fail(std::string_view why) {
  if (now_.state == MasterState::Fault) return;
  now_.state = MasterState::Fault;
  now_.why = held_ = why;
  now_.velocity = 0;
}

}  // namespace palp::surgeon
