#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/link/telegram.h"
#include "common/message/tick_view.h"
#include "common/record/mcap_format.h"
#include "common/record/recorder.h"

/// Records to the messages of proto/session_log.proto; one message type per topic.
namespace palp::record {

enum class Topic : std::uint8_t {
  Tick,
  TickView,
  Arrived,
  Link,
  Event,
  Contact,
  Depth,
  Hand,
  Stage,
  Force,
  Heard,
  User,
  Devices
};
inline constexpr std::size_t kTopicCount = 13;

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

/// Encodes in two steps, so that the bytes can be made where they shall stand. Its messages are
/// reused: after the first of each kind nothing is allocated. Thread: one.
class SessionEncoder {
 public:
  explicit SessionEncoder(link::Role site);
  ~SessionEncoder();
  SessionEncoder(const SessionEncoder&) = delete;
  SessionEncoder& operator=(const SessionEncoder&) = delete;

  /// nullopt: this site's file has no topic for such a record. `records_dropped` rides on
  /// LinkStatus.
  std::optional<Prepared> prepare(const Record& record, std::uint64_t records_dropped);
  Prepared prepare(const TickView& view);
  /// Writes the message prepared last; `place` has room for its size.
  void store(std::byte* place) const;

 private:
  struct Messages;
  std::unique_ptr<Messages> messages_;
};

}  // namespace palp::record
