#include "common/record/session_decoder.h"

#include <type_traits>

#include "common/message/log_bytes.h"
#include "common/message/log_schema.h"

namespace palp::record {
namespace {

using message::Event;
using message::EventKind;
using Answer = SessionDecoder::Answer;
using Verdict = SessionDecoder::Verdict;

template <class Message>
bool read(std::span<const std::byte> payload, Message& message) noexcept {
  return message::read_log(payload, message) && message::in_log_range(message);
}

/// A record whose message has its fields.
template <class Message>
Answer decode_record(std::span<const std::byte> payload, TimePoint at) noexcept {
  Message record;
  if (!read(payload, record)) return {.verdict = Verdict::Malformed, .record = {}};
  if constexpr (requires { record.at; }) record.at = at;
  return {.verdict = Verdict::Decoded, .record = record};
}

Answer decode_event(std::span<const std::byte> payload, TimePoint at) noexcept {
  Event event;
  bool good = message::read_log(payload, event);
  if (event.kind == EventKind::Note) event.from = event.to = {};  // a note has none
  good = good && message::in_log_range(event);
  if (!good) return {.verdict = Verdict::Malformed, .record = {}};
  if (event.kind == EventKind::Transition) {
    return {
        .verdict = Verdict::Decoded,
        .record = Transition{.at = at, .from = event.from, .to = event.to, .reason = event.code}};
  }
  return {.verdict = Verdict::Decoded,
          .record = Note{.at = at, .code = event.code, .detail = event.detail}};
}

Answer decode_view(std::span<const std::byte> payload) noexcept {
  TickView view;
  return {.verdict = message::read_log(payload, view) ? Verdict::View : Verdict::Malformed,
          .record = {}};
}

template <class Given>
Answer decode_given(std::span<const std::byte> payload) noexcept {
  Given given;
  return {.verdict = read(payload, given) ? Verdict::Gathered : Verdict::Malformed, .record = {}};
}

/// The record at the instant of its message.
template <class Part>
Record stamped(Part part, TimePoint at) noexcept {
  part.at = at;
  return part;
}

/// In files before protocol 4: a contact sample whose tip had passed a filter.
constexpr std::string_view kOldContact = "ContactSample";

/// Whether `name` is what either site calls this message.
template <class Message>
bool is_named(std::string_view name) noexcept {
  return name == message::log_name<Message>(false) || name == message::log_name<Message>(true);
}

template <class Message>
Answer decode_as(std::span<const std::byte> payload, TimePoint at) noexcept {
  if constexpr (std::is_same_v<Message, Event>)
    return decode_event(payload, at);
  else if constexpr (std::is_same_v<Message, TickView>)
    return decode_view(payload);
  else if constexpr (requires(Message given) { given.sampled; })
    return decode_given<Message>(payload);
  else
    return decode_record<Message>(payload, at);
}

/// As the message of the list that has this name.
template <class... Messages>
Answer decode_named(message::MessageList<Messages...> /*list*/,
                    std::string_view name,
                    std::span<const std::byte> payload,
                    TimePoint at) noexcept {
  Answer answer{.verdict = Verdict::Unknown, .record = {}};
  const auto try_as = [&]<class Message>(std::type_identity<Message> /*message*/) {
    if (!is_named<Message>(name)) return false;
    answer = decode_as<Message>(payload, at);
    return true;
  };
  (void)(try_as(std::type_identity<Messages>{}) || ...);
  return answer;
}

}  // namespace

Answer SessionDecoder::decode(std::string_view schema,
                              std::span<const std::byte> payload,
                              TimePoint at) noexcept {
  std::string_view name = schema;
  if (name.starts_with(message::kLogPackage)) {
    name.remove_prefix(message::kLogPackage.size());
    if (name.starts_with('.')) {
      name.remove_prefix(1);
      if (name == kOldContact) return {.verdict = Verdict::Old, .record = {}};
      return decode_named(message::LogMessages{}, name, payload, at);
    }
  }
  return {.verdict = Verdict::Unknown, .record = {}};
}

void SessionDecoder::scatter(std::string_view schema,
                             std::span<const std::byte> payload,
                             TimePoint at,
                             Parts& parts) noexcept {
  parts.clear();
  if (schema.ends_with(".SurgeonGiven")) {
    SurgeonGiven given;
    if (!read(payload, given)) return;
    if (given.sampled) parts.add(stamped(given.arrived, at));
    parts.add(stamped(given.hand, at));
    parts.add(stamped(given.heard, at));
  } else {
    PatientGiven given;
    if (!read(payload, given)) return;
    if (given.sampled) parts.add(stamped(given.arrived, at));
    parts.add(stamped(given.stage, at));
    parts.add(stamped(given.force, at));
    parts.add(stamped(given.heard, at));
  }
}

}  // namespace palp::record
