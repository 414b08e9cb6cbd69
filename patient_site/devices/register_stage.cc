#include "patient_site/devices/register_stage.h"

#include <algorithm>
#include <utility>

#include "common/core/lapse.h"

namespace palp::patient {
namespace {

/// A command outlives so many lost ticks, and no more: a site that hangs leaves no axis moving.
constexpr Duration kCommandValid = std::chrono::milliseconds{50};

constexpr Duration kNoSpin{0};

}  // namespace

DeviceThread::DeviceThread(std::string name,
                           DeviceProfile profile,
                           const DeviceInstallation& installation,
                           std::unique_ptr<io::RegisterPort> port,
                           int priority)
    : name_{std::move(name)},
      port_{std::move(port)},
      device_{std::move(profile), installation, *port_},
      thread_{"palp-device",
              {.period = device_.profile().period,
               .spin = kNoSpin,
               .priority = priority,
               .lock_memory = false},
              [this](TimePoint) { cycle(); }} {}

DeviceThread::~DeviceThread() {
  thread_.stop();
  device_.stop();
  port_->close();
}

void DeviceThread::cycle() {
  DeviceCommand command = command_.get();
  command.asks = requests_.newest();
  const DeviceReading reading = device_.cycle(clock_, command);
  to_rt_.put(reading);
  to_main_.put(reading);
}

/// The device's thread may itself be stuck in a call: age is judged here. While the caller stood
/// still so did that thread, perhaps.
bool RegisterStage::silent(std::size_t index, const DeviceReading& axis, TimePoint now) noexcept {
  const TimePoint heard_at = std::max(axis.sampled_at, awake_since_);
  const bool silent =
      axis.state == DeviceState::Ready && now - heard_at > axes_[index]->profile().silence;
  if (!std::exchange(silent_[index], silent) && silent) axes_[index]->count_silence();
  return silent;
}

StageState RegisterStage::read(TimePoint now) noexcept {
  if (now - at_ > kLateMax) awake_since_ = now;
  at_ = now;
  StageState state{.sampled_at = now};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i] == nullptr) continue;
    const DeviceReading& axis = axes_[i]->reading();
    state.faulted = state.faulted || axis.state != DeviceState::Ready || silent(i, axis, now);
    state.at_limit = state.at_limit || axis.at_limit;
    if (i == 0) {
      state.sampled_at = std::min(now, axis.sampled_at);
      state.position = axis.position;
      state.velocity = axis.velocity;
    } else {
      (i == 1 ? state.place.x : state.place.y) = axis.position;
    }
  }
  return state;
}

void RegisterStage::move_to(const StageTarget& target) noexcept {
  const std::array<double, 3> targets{target.position, target.place.x, target.place.y};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i] == nullptr) continue;
    axes_[i]->command(
        {.move = true, .target = targets[i], .valid_until = at_ + kCommandValid, .asks = {}});
  }
}

void RegisterStage::halt() noexcept {
  for (DeviceThread* const axis : axes_) {
    if (axis != nullptr) axis->command({});
  }
}

std::optional<ForceSample> RegisterForce::sample(TimePoint now) noexcept {
  const DeviceReading& cell = cell_.reading();
  if (cell.state != DeviceState::Ready || cell.number == number_) return std::nullopt;
  number_ = cell.number;
  return ForceSample{.sampled_at = std::min(now, cell.sampled_at),
                     .force = cell.force,
                     .saturated = cell.saturated};
}

}  // namespace palp::patient
