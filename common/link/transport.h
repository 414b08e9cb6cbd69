#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/core/time.h"

namespace palp::link {

inline constexpr std::size_t kDatagramSizeMax = 1200;     ///< [bytes], below any path MTU
inline constexpr std::size_t kDatagramsPerTickMax = 256;  ///< the rest waits for the next tick

struct Datagram {
  std::size_t size{};      ///< [bytes]; may exceed the buffer: then it was cut off, reject it
  TimePoint arrived_at{};  ///< in real time the kernel's receive stamp
};

/// One end of a lossy datagram pipe: may lose, repeat, reorder; never blocks, never allocates.
/// Thread: rt (its Link's).
class Transport {
 public:
  virtual ~Transport() = default;
  /// @returns false if dropped here; the caller counts it and goes on.
  virtual bool send(std::span<const std::byte> datagram, TimePoint now) noexcept = 0;
  /// @returns nullopt: none waiting.
  virtual std::optional<Datagram> receive(std::span<std::byte, kDatagramSizeMax> buffer,
                                          TimePoint now) noexcept = 0;
  /// What receive() gave last bears the connection id of the session. Nothing more is known of it.
  virtual void recognised(TimePoint /*now*/) noexcept {}
  /// In spare time: touches what receive() and send() will need. Takes nothing, sends nothing.
  virtual void warm_up() noexcept {}
};

}  // namespace palp::link
