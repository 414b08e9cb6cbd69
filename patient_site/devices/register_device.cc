#include "patient_site/devices/register_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/limits.h"

namespace palp::patient {
namespace {

using io::PortFault;

constexpr Duration kReopenPause = std::chrono::milliseconds{500};
constexpr Duration kHealthWait = std::chrono::seconds{1};  // after the last step of the start
constexpr std::uint32_t kRetriesMax = 3;
constexpr double kJumpSpeed = 3;        // [-], times the speed of the axis
constexpr double kReach = 0.1;          // [m], beyond its travel an axis may stand
constexpr double kVelocityShare = 0.5;  // of the newest difference
constexpr double kElsewhere = 5e-3;     // [m], and ...
constexpr double kElsewhereTime = 0.1;  // [s], at its speed: no axis goes further on its own
constexpr std::int64_t kStallPeriods = 5;
constexpr std::uint64_t kStateEvery = 10;  // readings
constexpr std::size_t kWriteWordsMax = 121;

}  // namespace

RegisterDevice::RegisterDevice(DeviceProfile profile,
                               const DeviceInstallation& installation,
                               io::RegisterPort& port)
    : profile_{std::move(profile)},
      installation_{installation},
      port_{port},
      words_{profile_.read_address, profile_.read_count},
      state_{profile_.state_address, profile_.state_count},
      load_{installation},
      seen_{.jumps = JumpAllowance{kJumpSpeed * installation.speed_max},
            .servo = ServoWatch{installation.servo}} {
  if (profile_.position && installation_.position_unit > 0) {
    profile_.position->unit = installation_.position_unit;
  }
  if (profile_.force && installation_.force_unit > 0) {
    profile_.force->unit = installation_.force_unit;
  }
}

DeviceReading RegisterDevice::cycle(const Clock& clock, const DeviceCommand& command) {
  const TimePoint now = clock.now();
  const DeviceAsks before = std::exchange(asks_, command.asks);
  load_.heed({.asked = before.tares != asks_.tares,
              .ready = now_.state == DeviceState::Ready,
              .may_touch = asks_.may_touch});
  now_.tare = load_.news();
  if (before.restarts != asks_.restarts && now_.state == DeviceState::Fault) {
    by_person_ = {};
    enter_start(now);
  }
  if (now_.state == DeviceState::Absent) reach(now);
  if (now_.state == DeviceState::Absent) return now_;
  if (now_.state == DeviceState::Ready) steer(command, now);
  if (poll(clock)) {
    judge(clock.now());
    if (now_.state == DeviceState::Starting) proceed(clock.now());
  }
  if (now_.state == DeviceState::Ready && !profile_.exchange) send_move(clock.now());
  return now_;
}

void RegisterDevice::stop() {
  if (now_.state == DeviceState::Absent || !profile_.stop) return;
  (void)send(*profile_.stop);
}

void RegisterDevice::reach(TimePoint now) {
  if (tried_ && now < reopen_at_) return;
  tried_ = true;
  reopen_at_ = now + kReopenPause;
  const PortFault fault = port_.open();
  if (fault != PortFault::None) {
    now_.reason = DeviceReason::Port;
    now_.detail = static_cast<std::uint32_t>(fault);
    return;
  }
  heard_at_ = now;
  failed_in_a_row_ = 0;
  enter_start(now);
  // No line frees it of its fault.
  if (by_person_.held != DeviceReason::None) fail(by_person_.held, by_person_.held_detail);
}

void RegisterDevice::enter_start(TimePoint now) noexcept {
  now_.state = DeviceState::Starting;
  now_.reason = DeviceReason::None;
  now_.detail = 0;
  now_.saturated = false;
  step_ = 0;
  step_sent_ = false;
  step_began_ = lived_at_ = now;
  polls_ = 0;
  seen_.known = anything_sent_ = false;
  seen_.jumps.reset();
  load_.resume();
}

bool RegisterDevice::poll(const Clock& clock) {
  const TimePoint began = clock.now();
  PortFault fault{};
  if (profile_.exchange && now_.state == DeviceState::Ready) {
    std::array<std::uint16_t, kWriteWordsMax> written{};
    const std::size_t count = words_of(profile_.move.front(), written);
    fault = port_.exchange(profile_.move.front().address,
                           std::span{written}.first(count),
                           profile_.read_address,
                           words_.words());
  } else {
    fault = port_.read(profile_.read_address, words_.words(), profile_.input_registers);
  }
  const TimePoint ended = clock.now();
  if (fault == PortFault::None && profile_.state_count > 0 && polls_ % kStateEvery == 0) {
    fault = port_.read(profile_.state_address, state_.words(), profile_.input_registers);
  }
  if (fault == PortFault::None) ++polls_;
  note_transfer(fault, ended);
  if (fault != PortFault::None) {
    motion_ = delivered_;  // what did not arrive is not made up for
    return false;
  }
  if (profile_.exchange) delivered_ = motion_;
  heard_at_ = ended;
  take_reading(began + (ended - began) / 2);
  return true;
}

void RegisterDevice::note_transfer(PortFault fault, TimePoint now) {
  if (fault == PortFault::None) {
    failed_in_a_row_ = 0;
    return;
  }
  ++now_.failures;
  ++failed_in_a_row_;
  const auto detail = static_cast<std::uint32_t>(fault);
  if (fault == PortFault::Refused) {
    if (now_.state != DeviceState::Fault) fail(DeviceReason::Port, detail);
    return;
  }
  const bool gone = fault == PortFault::Lost || fault == PortFault::NotOpen;
  const bool wrong_answers = fault != PortFault::NoReply && failed_in_a_row_ > kRetriesMax;
  if (!gone && !wrong_answers && now - heard_at_ <= profile_.silence) return;
  port_.close();
  now_.state = DeviceState::Absent;
  now_.reason = DeviceReason::Port;
  now_.detail = detail;
  now_.velocity = 0;
  reopen_at_ = now + kReopenPause;
}

void RegisterDevice::take_reading(TimePoint sampled_at) {
  ++now_.number;
  if (profile_.position) take_position(sampled_at);
  if (profile_.force) take_force(sampled_at);
  now_.sampled_at = sampled_at;
}

void RegisterDevice::take_position(TimePoint sampled_at) {
  const double read = words_.counts(*profile_.position, profile_.order) * profile_.position->unit;
  if (!std::isfinite(read)) {
    if (now_.state != DeviceState::Fault) fail(DeviceReason::NotFinite, 0);
    return;
  }
  const double position = (read - installation_.zero) * (installation_.reversed ? -1 : 1);
  const double span = seconds(sampled_at - now_.sampled_at);
  const double way = position - now_.position;
  if (seen_.known && now_.state == DeviceState::Ready && seen_.jumps.jumped(way, span)) {
    return fail(DeviceReason::Jumped, 0);
  }
  if (now_.state == DeviceState::Ready && !within_reach(position)) {
    return fail(DeviceReason::OutOfReach, 0);
  }
  now_.velocity =
      seen_.known && span > 0 ? now_.velocity + kVelocityShare * (way / span - now_.velocity) : 0;
  now_.position = position;
  seen_.known = true;
  if (now_.state == DeviceState::Ready) by_person_.stood_at = position;
}

void RegisterDevice::take_force(TimePoint sampled_at) {
  const double read = words_.counts(*profile_.force, profile_.order) * profile_.force->unit;
  const double force = installation_.force_reversed ? -read : read;
  const bool ready = now_.state == DeviceState::Ready || now_.state == DeviceState::Starting;
  // Steps that move it, or switch it on, come before the tare.
  if (!load_.tared() && step_ < profile_.start.size()) return;
  const LoadCheck::Verdict verdict = load_.take(force, sampled_at);
  now_.saturated = verdict == LoadCheck::Verdict::Saturated;
  if (verdict == LoadCheck::Verdict::NotFinite) {
    if (ready) fail(DeviceReason::NotFinite, 0);
    return;
  }
  now_.zero = load_.zero();
  now_.tare = load_.news();
  now_.force = force - load_.zero();
  if (!ready) return;
  if (verdict == LoadCheck::Verdict::Stuck) fail(DeviceReason::Stuck, 0);
  if (verdict == LoadCheck::Verdict::Touched) fail(DeviceReason::Touched, 0);
  if (verdict == LoadCheck::Verdict::Overloaded) fail(DeviceReason::Overloaded, 0);
}

/// A wrong unit or word order makes metres of millimetres; a target in them sends it anywhere.
bool RegisterDevice::within_reach(double position) const noexcept {
  return position > installation_.travel_min - kReach &&
         position < installation_.travel_max + kReach;
}

bool RegisterDevice::meets(const RegisterCondition& condition) const noexcept {
  return (words_.holds(condition.address, 1) ? words_ : state_).meets(condition);
}

std::optional<std::uint32_t> RegisterDevice::unhealthy() const noexcept {
  for (std::uint32_t i = 0; i < profile_.healthy.size(); ++i) {
    if (!meets(profile_.healthy[i])) return i;
  }
  return std::nullopt;
}

void RegisterDevice::judge(TimePoint now) {
  if (profile_.life) {
    const std::uint16_t life = words_.word(*profile_.life);
    if (std::exchange(life_, life) != life) lived_at_ = now;
  }
  if (now_.state != DeviceState::Ready) return;
  if (const auto index = unhealthy()) fail(DeviceReason::NotHealthy, *index);
  if (profile_.life && now - lived_at_ > profile_.life_within) fail(DeviceReason::NoLife, 0);
  watch_motion();
}

/// Whatever state the site is in: also while it holds, or has stopped, and the axis does not.
void RegisterDevice::watch_motion() noexcept {
  if (now_.state != DeviceState::Ready || !profile_.position || profile_.move.empty()) return;
  if (seen_.servo.judge(now_.position, delivered_.command, profile_.period)) {
    fail(DeviceReason::NotWhereSent, 0);
  }
}

void RegisterDevice::next_step(TimePoint now) noexcept {
  ++step_;
  step_sent_ = false;
  step_began_ = now;
}

void RegisterDevice::proceed(TimePoint now) {
  if (step_ < profile_.start.size()) {
    const StartStep& step = profile_.start[step_];
    const auto index = static_cast<std::uint32_t>(step_);
    if (!step_sent_ && step.unless && meets(*step.unless)) return next_step(now);
    if (!step_sent_) {
      if (step.moves && !installation_.may_home) return fail(DeviceReason::MayNotMove, index);
      if (step.moves && !by_person_.started) return fail(DeviceReason::MovesWhenAsked, index);
      if (step.unasked && !by_person_.started && !meets(*step.unasked)) {
        return fail(DeviceReason::CameBackOther, index);
      }
      const PortFault fault = send(step.write);
      if (fault == PortFault::Refused) return fail(DeviceReason::StartFailed, index);
      note_transfer(fault, now);
      step_sent_ = fault == PortFault::None;
      step_began_ = now;
      return;
    }
    if (!step.until || meets(*step.until)) return next_step(now);
    if (now - step_began_ > step.wait_max) fail(DeviceReason::StartFailed, index);
    return;
  }
  if (const auto index = unhealthy()) {
    if (now - step_began_ > kHealthWait) fail(DeviceReason::NotHealthy, *index);
    return;
  }
  if (profile_.position && !within_reach(now_.position)) return fail(DeviceReason::OutOfReach, 0);
  if (profile_.position && !by_person_.started &&
      std::abs(now_.position - by_person_.stood_at) >
          kElsewhere + kElsewhereTime * installation_.speed_max) {
    return fail(DeviceReason::StandsElsewhere, 0);
  }
  if (profile_.force && !load_.tared()) return;
  now_.state = DeviceState::Ready;
  ++now_.starts;
  by_person_.started = false;
  by_person_.stood_at = now_.position;
  begin_motion(now);
}

void RegisterDevice::begin_motion(TimePoint now) noexcept {
  motion_ = delivered_ = {.command = now_.position, .velocity = 0};
  seen_.servo.reset();
  steered_at_ = now;
}

/// What the thread slept through, the axis has stood: from there it sets out again.
void RegisterDevice::steer(const DeviceCommand& command, TimePoint now) noexcept {
  const Duration passed = now - steered_at_;
  if (passed > kStallPeriods * profile_.period) begin_motion(now);
  steered_at_ = now;
  const double span = seconds(std::clamp(passed, profile_.period / 2, 2 * profile_.period));
  const bool valid = command.move && now <= command.valid_until && std::isfinite(command.target);
  const double target =
      std::clamp(valid ? command.target : 0.0, installation_.travel_min, installation_.travel_max);
  now_.at_limit = valid && target != command.target;
  const double before = motion_.command;
  if (valid) {
    motion_ = step_axis(motion_,
                        target,
                        {.speed = installation_.speed_max,
                         .acceleration = installation_.acceleration_max,
                         .step_free = 0},
                        span);
  } else {
    motion_.velocity = step_towards(motion_.velocity, 0, installation_.acceleration_max * span);
    motion_.command += motion_.velocity * span;
  }
  // Where it stands outside its travel, it may stay there and come back.
  const double within = std::clamp(motion_.command,
                                   std::min(installation_.travel_min, before),
                                   std::max(installation_.travel_max, before));
  if (within != motion_.command) motion_ = {.command = within, .velocity = 0};
}

double RegisterDevice::raw_position(double position) const noexcept {
  return installation_.zero + (installation_.reversed ? -position : position);
}

std::size_t RegisterDevice::words_of(const RegisterWrite& write,
                                     std::span<std::uint16_t> words) const noexcept {
  std::size_t count = 0;
  for (const WriteValue& value : write.values) {
    double counts = value.number;
    // A target is in the unit in which the device reads its position.
    const double place = profile_.position ? profile_.position->unit : 1;
    const double unit = value.unit > 0 ? value.unit : place;
    if (value.source == ValueSource::Position) counts = raw_position(motion_.command) / place;
    if (value.source == ValueSource::Here) counts = raw_position(now_.position) / place;
    if (value.source == ValueSource::Speed) counts = installation_.speed_max / unit;
    if (value.source == ValueSource::Acceleration) counts = installation_.acceleration_max / unit;
    if (value.source == ValueSource::ForceLimit) counts = installation_.force_limit / unit;
    const auto pair = to_words(counts, value.kind, profile_.order);
    for (std::size_t i = 0; i < words_in(value.kind) && count < words.size(); ++i) {
      words[count++] = pair[i];
    }
  }
  return count;
}

PortFault RegisterDevice::send(const RegisterWrite& write) {
  std::array<std::uint16_t, kWriteWordsMax> words{};
  const std::size_t count = words_of(write, words);
  if (write.kind == WriteKind::Coil) return port_.write_coil(write.address, words[0] != 0);
  if (write.kind == WriteKind::OneRegister) return port_.write_one(write.address, words[0]);
  return port_.write(write.address, std::span{words}.first(count));
}

void RegisterDevice::send_move(TimePoint now) {
  if (profile_.move.empty() || !profile_.position) return;
  const double counts = raw_position(motion_.command) / profile_.position->unit;
  const auto target = to_words(counts, profile_.position->kind, profile_.order);
  if (profile_.only_changes && anything_sent_ && target == sent_) return;
  PortFault fault{};
  for (const RegisterWrite& one : profile_.move) {
    if (fault == PortFault::None) fault = send(one);
  }
  note_transfer(fault, now);
  if (fault != PortFault::None) {
    motion_ = delivered_;
    return;
  }
  delivered_ = motion_;
  sent_ = target;
  anything_sent_ = true;
}

void RegisterDevice::fail(DeviceReason reason, std::uint32_t detail) {
  if (now_.state == DeviceState::Fault) return;
  now_.state = DeviceState::Fault;
  now_.reason = by_person_.held = reason;
  now_.detail = by_person_.held_detail = detail;
  now_.velocity = 0;
  if (profile_.stop) (void)send(*profile_.stop);
}

}  // namespace palp::patient
