#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "common/link/packet_protection.h"
#include "common/link/traffic_keys.h"

namespace palp::link {

/// Header authenticated, payload sealed: AES-256-GCM (NIST SP 800-38D). Connection id and number
/// are hidden by a mask that a key of its own makes of the tag (as in RFC 9001, 5.4): who listens
/// cannot tell that two datagrams are of one session. The nonce is the salt of the direction xor
/// the packet number (as in RFC 8446, 5.3), so that it is new as long as the number is. Holds the
/// keys of up to two generations: in a changeover what is under way under the old one still opens.
/// Thread: made off rt; then its owner's. Allocates and locks nothing after construction.
class AeadProtection final : public PacketProtection {
 public:
  static constexpr std::size_t kTagSize = 16;  ///< [bytes]
  /// No more packets than these under one key: far below the limit of GCM (2^32 invocations are
  /// the bound for random nonces), and years at 1 kHz away; keys are replaced within hours.
  static constexpr std::uint64_t kPacketsMax = 1ULL << 30U;

  /// Who seals first with the newer keys.
  enum class Lead : std::uint8_t {
    Own,   ///< we: the peer is known to have them
    Peer,  ///< once something sealed with them has come
  };

  /// Throws std::runtime_error where OpenSSL has no AES-256-GCM.
  explicit AeadProtection(const TrafficKeys& keys);
  /// `next` must have another id than `present`.
  AeadProtection(const TrafficKeys& present, const TrafficKeys& next, Lead lead);
  ~AeadProtection() override;
  AeadProtection(const AeadProtection&) = delete;
  AeadProtection& operator=(const AeadProtection&) = delete;

  [[nodiscard]] std::size_t overhead() const noexcept override { return kTagSize; }
  /// Sets the header's key id itself. Numbers must grow (PALP_CHECK: a nonce would come twice).
  std::size_t seal(const Header& header,
                   std::span<const std::byte> plain,
                   std::span<std::byte> out) noexcept override;
  tl::expected<Header, Rejection> read_header(
      std::span<const std::byte> datagram) noexcept override;
  tl::expected<std::size_t, Rejection> open(const Header& header,
                                            std::span<const std::byte> datagram,
                                            std::span<std::byte> plain) noexcept override;
  void warm_up(std::span<const std::byte> plain, std::span<std::byte> room) noexcept override;

 private:
  struct Generation;
  /// null: no keys of this id.
  [[nodiscard]] Generation* keys_of(const Header& header) noexcept;

  std::unique_ptr<Generation> present_;
  std::unique_ptr<Generation> next_;     ///< null: no changeover
  std::unique_ptr<Generation> warm_up_;  ///< of keys that everybody knows
  bool seals_with_next_{};
  std::uint64_t number_least_{};  ///< that may be sealed next
};

}  // namespace palp::link
