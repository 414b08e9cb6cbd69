#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/record/session_encoder.h"

/// The frames of the Foxglove WebSocket protocol (subprotocol foxglove.sdk.v1): texts are JSON,
/// bytes are little-endian. Pure; any bytes may come in.
namespace palp::monitor {

/// What current clients offer; both have the same frames.
inline constexpr std::string_view kSubprotocols[]{"foxglove.sdk.v1", "foxglove.websocket.v1"};
/// Of a client's list, the one it likes best, the first that is ours; empty: none.
[[nodiscard]] std::string_view subprotocol_of(std::string_view offered) noexcept;

/// A topic as clients see it.
struct Channel {
  std::uint32_t id{};
  std::string topic;
  std::string encoding;  ///< protobuf or json
  std::string schema_name;
  std::string schema;  ///< base64 of the FileDescriptorSet, or a JSON schema
};
/// The protobuf ones are the session file's, schema for schema.
[[nodiscard]] Channel channel_of(const record::TopicFormat& format);

struct Service {
  std::uint32_t id{};
  std::string name;
};

/// Who serves, and what it lets a client do.
struct Greeting {
  std::string name;
  std::string run;    ///< another at each start: clients forget what they held
  bool controllable;  ///< clients may publish and call services
  std::vector<std::pair<std::string, std::string>> facts{};
};

enum class Level : std::uint8_t { Info, Warning, Error };

[[nodiscard]] std::string greeting_text(const Greeting& greeting);
[[nodiscard]] std::string advertise_text(const std::vector<Channel>& channels);
[[nodiscard]] std::string services_text(const std::vector<Service>& services);
[[nodiscard]] std::string status_text(Level level, std::string_view sentence);
[[nodiscard]] std::string call_failure_text(std::uint32_t service,
                                            std::uint32_t call,
                                            std::string_view sentence);

[[nodiscard]] std::string message_bytes(std::uint32_t subscription,
                                        std::uint64_t stamp,
                                        std::span<const std::byte> payload);
/// `json` is the answer.
[[nodiscard]] std::string call_answer_bytes(std::uint32_t service,
                                            std::uint32_t call,
                                            std::string_view json);

/// A text of a client.
struct ClientText {
  enum class Op : std::uint8_t { Other, Subscribe, Unsubscribe, Advertise, Unadvertise };
  struct Subscription {
    std::uint32_t id{};
    std::uint32_t channel{};
  };
  struct Publication {
    std::uint32_t id{};
    std::string topic;
    std::string encoding;
  };
  Op op{};
  std::vector<Subscription> subscriptions;
  std::vector<Publication> publications;
  std::vector<std::uint32_t> ids;  ///< of what ends
};
/// nullopt: no text of this protocol. Parts that make no sense are left out.
[[nodiscard]] std::optional<ClientText> read_client_text(std::string_view text);

/// Bytes of a client: a message on a channel of its own, or a call.
struct ClientBytes {
  bool call{};
  std::uint32_t id{};  ///< of the channel or the service
  std::uint32_t call_id{};
  std::string_view encoding;
  std::string_view payload;
};
/// nullopt: no bytes of this protocol. Refers to `bytes`.
[[nodiscard]] std::optional<ClientBytes> read_client_bytes(std::string_view bytes);

/// Whether a text nests so little that it may be read as JSON.
[[nodiscard]] bool is_shallow(std::string_view text) noexcept;

}  // namespace palp::monitor
