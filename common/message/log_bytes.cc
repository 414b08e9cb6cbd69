#include "common/message/log_bytes.h"

#include "common/message/range.h"
#include "common/message/read_fields.h"
#include "common/message/write_fields.h"

namespace palp::message {

template <class Message>
std::size_t write_log(const Message& from, std::span<std::byte, kLogMessageSizeMax> out) noexcept {
  static_assert(size_max<Form::Log, Message>() <= kLogMessageSizeMax);
  WireWriter writer{out};
  write<Form::Log>(from, writer);
  return writer.size();
}

template <class Message>
bool read_log(std::span<const std::byte> bytes, Message& to) noexcept {
  clear(to);
  Seen seen = 0;
  return read<Form::Log>(WireReader{bytes}, to, seen);
}

template <class Message>
bool in_log_range(const Message& message) noexcept {
  return in_range<Form::Log>(message);
}

/// Makes the three of one message.
template <class Message>
struct BytesOf {
  static constexpr auto kWrite = &write_log<Message>;
  static constexpr auto kRead = &read_log<Message>;
  static constexpr auto kInRange = &in_log_range<Message>;
};
template struct BytesOf<SiteTick>;
template struct BytesOf<TickView>;
template struct BytesOf<Arrived>;
template struct BytesOf<LinkStatus>;
template struct BytesOf<Event>;
template struct BytesOf<ContactSample>;
template struct BytesOf<DepthEstimate>;
template struct BytesOf<DepthArrived>;
template struct BytesOf<HandReading>;
template struct BytesOf<StageReading>;
template struct BytesOf<ForceReading>;
template struct BytesOf<LinkHeard>;
template struct BytesOf<UserAsked>;
template struct BytesOf<DevicesTold>;

}  // namespace palp::message
