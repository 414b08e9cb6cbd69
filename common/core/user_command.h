#pragma once

#include <cstdint>

namespace palp {

/// What the user asks of a site by other means than a device. The newest counts.
struct UserCommand {
  bool emergency_stop{};   ///< as long as it is set
  std::uint32_t resets{};  ///< one more: leave state Stopped
};

}  // namespace palp
