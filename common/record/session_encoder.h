#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/link/telegram.h"
#include "common/message/log_bytes.h"
#include "common/record/mcap_format.h"

/// Records to the messages of proto/session_log.proto; one message type per topic.
namespace palp::record {

enum class Topic : std::uint8_t {
  Tick,
  TickView,
  Arrived,
  Link,
  Event,
  Depth,
  Hand,
  Stage,
  Force,
  Heard,
  User,
  Devices,
  Truth,
  Map,
  MapCell
};
inline constexpr std::size_t kTopicCount = 15;

struct TopicFormat {
  Topic topic{};
  std::string name;    ///< "surgeon/tick"
  std::string schema;  ///< full name of the message, "palp.session.SurgeonTick"
  Bytes descriptors;   ///< FileDescriptorSet: the message and the types it uses, no others
};

/// The topics of one site's file, in the order of the enumeration.
[[nodiscard]] std::vector<TopicFormat> topics_of(link::Role site);

/// "surgeon" or "patient".
[[nodiscard]] std::string_view site_name(link::Role site) noexcept;

struct Prepared {
  Topic topic{};
  TimePoint at{};      ///< the sample's own instant
  std::size_t size{};  ///< [bytes]
};

/// Encodes in two steps, because a place in the file is asked for by its size. Allocates nothing.
/// Thread: one.
class SessionEncoder {
 public:
  explicit SessionEncoder(link::Role site) noexcept : site_{site} {}

  /// nullopt: this site's file has no topic for such a record. `records_dropped` rides on
  /// LinkStatus.
  std::optional<Prepared> prepare(const Record& record, std::uint64_t records_dropped);
  Prepared prepare(const TickView& view) noexcept;
  /// A tick of the site with what it was given.
  Prepared prepare(const SurgeonFileTick& tick) noexcept;
  Prepared prepare(const PatientFileTick& tick) noexcept;
  /// Writes the message prepared last; `place` has room for its size.
  void store(std::byte* place) const noexcept;

 private:
  template <class Message>
  Prepared write(Topic topic, TimePoint at, const Message& message) noexcept;

  link::Role site_;
  std::size_t size_{};
  std::array<std::byte, message::kLogMessageSizeMax> bytes_{};
};

}  // namespace palp::record
