#include "common/link/traffic_keys.h"

#include <utility>

namespace palp::link {
namespace {

class Cutter {
 public:
  explicit Cutter(std::span<const std::byte> bytes) noexcept : rest_{bytes} {}

  AeadKey key() noexcept {
    const Secret<AeadKey::kKeySize> key{take<AeadKey::kKeySize>()};
    const Secret<AeadKey::kSaltSize> salt{take<AeadKey::kSaltSize>()};
    return {.key = key,
            .salt = salt,
            .header_key = Secret<AeadKey::kKeySize>{take<AeadKey::kKeySize>()}};
  }
  /// Never 0, which means "none" in a header.
  std::uint32_t connection() noexcept {
    std::uint32_t value = 0;
    for (const std::byte byte : take<sizeof value>()) {
      value = value << 8U | std::to_integer<std::uint32_t>(byte);
    }
    return value | 1U;
  }

 private:
  template <std::size_t kSize>
  std::span<const std::byte, kSize> take() noexcept {
    const auto taken = rest_.first<kSize>();
    rest_ = rest_.subspan(kSize);
    return taken;
  }
  std::span<const std::byte> rest_;
};

}  // namespace

SessionKeys SessionKeys::from_exported(std::span<const std::byte, kExportedSize> bytes,
                                       Role role) noexcept {
  Cutter cutter{bytes};
  SessionKeys keys;
  for (TrafficKeys* plane : {&keys.data, &keys.control}) {
    plane->send = cutter.key();  // from surgeon to patient
    plane->receive = cutter.key();
  }
  keys.send_connection = cutter.connection();
  keys.receive_connection = cutter.connection();
  if (role == Role::Patient) {
    std::swap(keys.data.send, keys.data.receive);
    std::swap(keys.control.send, keys.control.receive);
    std::swap(keys.send_connection, keys.receive_connection);
  }
  return keys;
}

PlaneKeys PlaneKeys::from_exported(std::span<const std::byte, kExportedSize> bytes,
                                   Role role) noexcept {
  Cutter cutter{bytes};
  PlaneKeys plane;
  plane.keys.send = cutter.key();  // from surgeon to patient
  plane.keys.receive = cutter.key();
  plane.send_connection = cutter.connection();
  plane.receive_connection = cutter.connection();
  if (role == Role::Patient) {
    std::swap(plane.keys.send, plane.keys.receive);
    std::swap(plane.send_connection, plane.receive_connection);
  }
  return plane;
}

}  // namespace palp::link
