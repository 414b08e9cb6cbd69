#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/core/device_facts.h"
#include "common/link/telegram.h"

/// The messages that sites exchange before and after a session, as bytes (proto/link.proto).
/// Thread: any but rt; these allocate.
namespace palp::link {

inline constexpr std::uint32_t kProtocolVersion = 11;
inline constexpr std::size_t kNameSizeMax = 40;      ///< [bytes], coupling and git
inline constexpr std::size_t kTextSizeMax = 160;     ///< [bytes], a sentence
inline constexpr std::size_t kControlSizeMax = 512;  ///< [bytes], any control message

/// "Here I am." The first of all messages, and the answer to it.
struct Hello {
  std::uint32_t protocol_version{kProtocolVersion};
  Role role{};
  std::uint64_t session_id{};       ///< the sender's, for one session only; never 0
  std::uint64_t peer_session_id{};  ///< echo of the receiver's; 0: not known
  std::uint32_t connection_id{};    ///< to be put into what is sent to the sender; 0: not known
  std::uint64_t settings_hash{};    ///< of everything both sites must agree on
  std::string coupling;
  std::string git;        ///< for people
  DeviceFacts devices{};  ///< the sender's; their numbers may be anything
};

enum class ByeReason : std::uint8_t { Leaving, Busy, Mismatch };
inline constexpr int kByeReasonCount = 3;

/// The end of a session, or why there will be none.
struct Bye {
  std::uint64_t session_id{};
  std::uint64_t peer_session_id{};
  ByeReason reason{};
  std::string text;  ///< one sentence for people
};

/// One encoded message.
struct ControlBytes {
  std::array<std::byte, kControlSizeMax> bytes{};
  std::size_t size{};
  [[nodiscard]] std::span<const std::byte> view() const noexcept {
    return std::span{bytes}.first(size);
  }
};

/// Text that is too long is cut.
[[nodiscard]] ControlBytes encode(const Hello& hello);
[[nodiscard]] ControlBytes encode(const Bye& bye);

/// Any bytes may be given. Unknown fields are skipped; text comes out printable: what is not ASCII
/// is shown as '?'. @returns nullopt where a field breaks its limits.
[[nodiscard]] std::optional<Hello> decode_hello(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<Bye> decode_bye(std::span<const std::byte> bytes);

}  // namespace palp::link
