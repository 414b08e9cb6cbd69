#pragma once

#include "common/core/mailbox.h"
#include "patient_site/devices/device_reading.h"

namespace palp::patient {

/// What a device on a thread of its own is asked for, by a person and by the site.
class DeviceRequests {
 public:
  /// Thread: main. Out of a fault, if it is in one, to the beginning of its start.
  void restart() noexcept {
    ++asked_.restarts;
    asks_.put(asked_);
  }
  /// Thread: main. A new tare, while it is ready and touches nothing; its news is in the reading.
  void tare() noexcept {
    ++asked_.tares;
    asks_.put(asked_);
  }
  /// Thread: rt, once a tick.
  void expect_touch(bool may_touch) noexcept { may_touch_.put(may_touch); }
  /// Thread: the device's.
  [[nodiscard]] DeviceAsks newest() noexcept {
    DeviceAsks asks = asks_.get();
    asks.may_touch = may_touch_.get();
    return asks;
  }

 private:
  DeviceAsks asked_;          ///< main's
  Mailbox<DeviceAsks> asks_;  ///< writer: main; reader: device
  Mailbox<bool> may_touch_;   ///< writer: rt; reader: device
};

}  // namespace palp::patient
