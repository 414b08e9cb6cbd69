#include "common/record/session_decoder.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "common/message/log_bytes.h"
#include "common/message/log_schema.h"
#include "common/record/log_line.h"
#include "common/record/said_twice.h"

namespace palp::record {
namespace {

using message::Event;
using message::EventKind;
using Parts = SessionDecoder::Parts;
using Verdict = SessionDecoder::Verdict;

/// Adds a record at the instant of its message.
template <class Part>
void add(Part part, TimePoint at, Parts& parts) noexcept {
  if constexpr (requires { part.at; }) part.at = at;
  parts.add(part);
}

template <class Given>
void add_given(const Given& given, const SiteTick* tick, TimePoint at, Parts& parts) noexcept {
  if (given.samples > 1) add(given.earlier, at, parts);
  if (given.samples > 0) add(given.arrived, at, parts);
  if (tick != nullptr) add(*tick, at, parts);
  if constexpr (requires { given.hand; }) {
    add(given.hand, at, parts);
  } else {
    add(given.stage, at, parts);
    add(given.force, at, parts);
  }
  add(given.heard, at, parts);
}

void add_event(const Event& event, TimePoint at, Parts& parts) noexcept {
  if (event.kind == EventKind::Transition) {
    add(Transition{.at = at, .from = event.from, .to = event.to, .reason = event.code}, at, parts);
  } else {
    add(Note{.at = at, .code = event.code, .detail = event.detail}, at, parts);
  }
}

/// Contact samples: the ticks say them.
constexpr std::array<std::string_view, 2> kOldNames{"ContactSample", "ContactReading"};

/// Whether `name` is what either site calls this message.
template <class Message>
bool is_named(std::string_view name) noexcept {
  return name == message::log_name<Message>(false) || name == message::log_name<Message>(true);
}

template <class Message>
Verdict decode_as(std::span<const std::byte> payload, TimePoint at, Parts& parts) noexcept {
  Message message;
  bool good = message::read_log(payload, message);
  if constexpr (std::is_same_v<Message, TickView>) return good ? Verdict::View : Verdict::Malformed;
  if constexpr (std::is_same_v<Message, Event>) {
    if (message.kind == EventKind::Note) message.from = message.to = {};  // a note has none
  }
  good = good && message::in_log_range(message);
  if (!good) return Verdict::Malformed;
  if constexpr (std::is_same_v<Message, Event>) {
    add_event(message, at, parts);
  } else if constexpr (requires { message.gathered; }) {
    if (message.gathered) {
      message.at = at;
      put_back(message);
      add_given(message.given, &message.tick, at, parts);
    } else {
      add(message.tick, at, parts);
    }
  } else if constexpr (requires { message.samples; }) {
    add_given(message, nullptr, at, parts);
  } else if constexpr (std::is_constructible_v<Record, Message>) {
    add(message, at, parts);
  }
  return Verdict::Decoded;
}

/// As the message of the list that has this name.
template <class... Messages>
Verdict decode_named(message::MessageList<Messages...> /*list*/,
                     std::string_view name,
                     std::span<const std::byte> payload,
                     TimePoint at,
                     Parts& parts) noexcept {
  Verdict verdict = Verdict::Unknown;
  const auto try_as = [&]<class Message>(std::type_identity<Message> /*message*/) {
    if (!is_named<Message>(name)) return false;
    verdict = decode_as<Message>(payload, at, parts);
    return true;
  };
  (void)(try_as(std::type_identity<Messages>{}) || ...);
  return verdict;
}

/// Foxglove's, of the camera: no record tells of a picture.
constexpr std::string_view kPictureSchemas{"foxglove.Compressed"};

}  // namespace

Verdict SessionDecoder::decode(std::string_view schema,
                               std::span<const std::byte> payload,
                               TimePoint at,
                               Parts& parts) noexcept {
  parts.clear();
  if (schema == kLogLineSchema || schema.starts_with(kPictureSchemas)) return Verdict::View;
  if (!schema.starts_with(message::kLogPackage)) return Verdict::Unknown;
  std::string_view name = schema.substr(message::kLogPackage.size());
  if (name.size() < 2 || name.front() != '.') return Verdict::Unknown;
  name.remove_prefix(1);
  if (std::ranges::find(kOldNames, name) != kOldNames.end()) return Verdict::Old;
  return decode_named(message::LogMessages{}, name, payload, at, parts);
}

}  // namespace palp::record
