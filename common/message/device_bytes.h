#pragma once

#include <cstddef>
#include <span>

#include "common/core/device_facts.h"

/// Message Devices of proto/shared.proto as a Hello carries it: every number is there, so that all
/// are of one length; of a device that a site has not, zeros. Thread: any; allocates nothing.
namespace palp::message {

inline constexpr std::size_t kDevicesSizeMax = 256;  ///< [bytes]

/// @returns bytes written.
std::size_t write_devices(const DeviceFacts& from,
                          std::span<std::byte, kDevicesSizeMax> out) noexcept;

/// Any bytes may be given; numbers may be anything. Unknown fields are skipped. A device whose
/// first number is 0 is none. @returns false where they are no such message.
[[nodiscard]] bool read_devices(std::span<const std::byte> bytes, DeviceFacts& to) noexcept;

}  // namespace palp::message
