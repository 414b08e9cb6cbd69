#include "common/io/secure/address_cookie.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include "common/io/secure/openssl_handles.h"

namespace palp::io {
namespace {

constexpr std::size_t kTimeSize = sizeof(std::uint64_t);
constexpr std::size_t kBoundMax = 64;  ///< [bytes]

std::uint64_t time_in(const AddressCookie::Bytes& cookie) noexcept {
  std::uint64_t time = 0;
  for (std::size_t i = 0; i < kTimeSize; ++i) {
    time = time << 8U | std::to_integer<std::uint64_t>(cookie[i]);
  }
  return time;
}

}  // namespace

AddressCookie::AddressCookie() {
  if (RAND_bytes(secret_.data(), static_cast<int>(secret_.size())) != 1) {
    throw std::runtime_error{"cannot draw a secret for cookies: " + openssl_complaint()};
  }
}

AddressCookie::Bytes AddressCookie::sealed(std::uint64_t time,
                                           const Endpoint& from,
                                           std::span<const std::byte> bound_to) const noexcept {
  Bytes cookie{};
  for (std::size_t i = 0; i < kTimeSize; ++i) {
    cookie[i] = static_cast<std::byte>(time >> (8 * (kTimeSize - 1 - i)) & 0xFFU);
  }
  std::array<std::byte, kTimeSize + sizeof(Endpoint::Bytes) + kBoundMax> text{};
  const Endpoint::Bytes address = from.bytes();
  const auto bound = bound_to.first(std::min(bound_to.size(), kBoundMax));
  auto* end = std::ranges::copy(std::span{cookie}.first(kTimeSize), text.begin()).out;
  end = std::ranges::copy(address, end).out;
  end = std::ranges::copy(bound, end).out;
  std::array<unsigned char, EVP_MAX_MD_SIZE> mac{};
  HMAC(EVP_sha256(),
       secret_.data(),
       static_cast<int>(secret_.size()),
       reinterpret_cast<const unsigned char*>(text.data()),
       static_cast<std::size_t>(end - text.begin()),
       mac.data(),
       nullptr);
  for (std::size_t i = kTimeSize; i < cookie.size(); ++i) {
    cookie[i] = static_cast<std::byte>(mac[i - kTimeSize]);
  }
  return cookie;
}

AddressCookie::Bytes AddressCookie::make(const Endpoint& from,
                                         std::span<const std::byte> bound_to,
                                         TimePoint now) const noexcept {
  return sealed(static_cast<std::uint64_t>(now.time_since_epoch().count()), from, bound_to);
}

std::optional<TimePoint> AddressCookie::made_at(const Bytes& cookie,
                                                const Endpoint& from,
                                                std::span<const std::byte> bound_to,
                                                TimePoint now) const noexcept {
  const std::uint64_t time = time_in(cookie);
  const Bytes right = sealed(time, from, bound_to);
  if (CRYPTO_memcmp(right.data(), cookie.data(), right.size()) != 0) return std::nullopt;
  const TimePoint made{Duration{static_cast<std::int64_t>(time)}};
  if (now - made > kLife || made > now) return std::nullopt;
  return made;
}

}  // namespace palp::io
