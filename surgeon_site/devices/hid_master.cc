#include "surgeon_site/devices/hid_master.h"

#include <algorithm>
#include <utility>

namespace palp::surgeon {
namespace {

/// A force outlives so many lost ticks, and no more: a site that hangs leaves no motor pushing.
constexpr Duration kForceValid = std::chrono::milliseconds{20};
/// The device's thread may itself be stuck in a call.
constexpr Duration kThreadStuck = std::chrono::milliseconds{50};
constexpr Duration kNoMasterSpin{0};

}  // namespace

MasterThread::MasterThread(std::string name,
                           std::unique_ptr<MasterProtocol> protocol,
                           const MasterInstallation& installation,
                           std::unique_ptr<io::ReportPort> port,
                           int priority)
    : name_{std::move(name)},
      port_{std::move(port)},
      device_{std::move(protocol), installation, *port_},
      thread_{"palp-device",
              {.period = installation.period,
               .spin = kNoMasterSpin,
               .priority = priority,
               .lock_memory = false},
              [this](TimePoint) { cycle(); }} {}

MasterThread::~MasterThread() {
  thread_.stop();
  device_.stop();
  port_->close();
}

void MasterThread::cycle() {
  MasterCommand command = command_.get();
  command.restarts = restarts_.get();
  const MasterReading reading = device_.cycle(clock_, command);
  to_rt_.put(reading);
  to_main_.put(reading);
}

HandState HidMaster::read(TimePoint now) noexcept {
  at_ = now;
  const MasterReading& reading = master_.reading();
  HandState state;
  state.sampled_at = std::min(now, reading.looked_at);
  state.position = reading.position;
  state.velocity = reading.velocity;
  state.place = reading.place;
  state.emergency_stop = reading.emergency_stop;
  state.faulted = reading.state != MasterState::Ready || now - reading.looked_at > kThreadStuck;
  state.pedal_held = reading.pedal_held && !state.faulted;
  return state;
}

void HidMaster::apply(double force) noexcept {
  command_.force = force;
  command_.valid_until = at_ + kForceValid;
  master_.command(command_);
}

// Told to the device with the force of the next tick.
void HidMaster::show(const OperatorView& view) noexcept {
  command_.engaged = view.state == SiteState::Engaged;
}

}  // namespace palp::surgeon
