#include "common/message/log_bytes.h"

#include <tuple>

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

/// Makes the three of each message.
template <class List>
struct BytesOf;
template <class... Messages>
struct BytesOf<MessageList<Messages...>> {
  static constexpr std::tuple kWrite{&write_log<Messages>...};
  static constexpr std::tuple kRead{&read_log<Messages>...};
  static constexpr std::tuple kInRange{&in_log_range<Messages>...};
};
template struct BytesOf<LogMessages>;

}  // namespace palp::message
