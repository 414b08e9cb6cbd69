#pragma once

#include "common/core/time.h"
#include "common/io/device/hid_port.h"
#include "surgeon_site/devices/master_device.h"
#include "tests/common/io/device/fake_hidapi.h"

namespace palp::surgeon {

/// A clock that a test turns; each look takes no time.
class TurnedClock final : public Clock {
 public:
  [[nodiscard]] TimePoint now() const noexcept override { return at; }
  TimePoint at{std::chrono::seconds{10}};
};

/// A master of one protocol over the fake of hidapi, in virtual time.
struct MasterBench {
  MasterBench(std::unique_ptr<MasterProtocol> protocol,
              const io::HidAddress& address,
              const MasterInstallation& installation)
      : port{address}, device{std::move(protocol), installation, port} {}
  ~MasterBench() {
    port.close();
    fake_hid::clear();
  }
  MasterBench(const MasterBench&) = delete;
  MasterBench& operator=(const MasterBench&) = delete;

  /// One period of 1 ms with a command that is valid.
  MasterReading step(double force = 0) {
    clock.at += std::chrono::milliseconds{1};
    command.force = force;
    command.valid_until = clock.at + std::chrono::milliseconds{20};
    return device.cycle(clock, command);
  }
  /// One period in which the site says nothing new.
  MasterReading step_unheard() {
    clock.at += std::chrono::milliseconds{1};
    return device.cycle(clock, command);
  }

  TurnedClock clock;
  MasterCommand command;
  io::HidPort port;
  MasterDevice device;
};

}  // namespace palp::surgeon
