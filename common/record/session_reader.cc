#include "common/record/session_reader.h"

#include <algorithm>
#include <charconv>

namespace palp::record {
namespace {

std::string value_of(const McapMap& map, std::string_view key) {
  const auto found =
      std::find_if(map.begin(), map.end(), [&](const auto& pair) { return pair.first == key; });
  return found == map.end() ? std::string{} : found->second;
}

// Kept of a file that says more.
constexpr std::size_t kSessionsMax = 4096;
constexpr std::size_t kAttachmentsMax = 4096;
constexpr std::size_t kNameSizeMax = 4096;                      ///< [bytes], of an attachment
constexpr std::size_t kMetadataSizeMax = std::size_t{4} << 20;  ///< [bytes]
constexpr std::size_t kEntrySize = 64;  ///< [bytes], that an entry takes beside its text

}  // namespace

SessionReader::SessionReader(const FileBytes& file, const McapLimits& limits)
    : mcap_{file, limits} {}

std::optional<SessionEntry> SessionReader::next() {
  if (const auto part = parts_.take()) return SessionEntry{.site = parts_of_, .record = *part};
  while (const auto item = mcap_.next()) {
    if (const auto* metadata = std::get_if<McapMetadata>(&*item)) {
      keep(*metadata);
    } else if (const auto* attachment = std::get_if<McapAttachment>(&*item)) {
      keep(*attachment);
    } else if (const auto* message = std::get_if<McapMessage>(&*item)) {
      count(*message);
      if (auto entry = decode(*message)) {
        return entry;
      }
    }
  }
  return std::nullopt;
}

void SessionReader::only_between(TimePoint from, TimePoint to) {
  window_ = Window{clock_.stamp(from), clock_.stamp(to)};
  mcap_.only_between(window_->from, window_->to);
  for (auto& [name, topic] : topics_) {
    topic.looked_at = false;
    topic.sequence = SequenceCount{};
    topic.dated_back = 0;
  }
}

void SessionReader::keep(const McapAttachment& attachment) {
  if (attachments_.size() >= kAttachmentsMax || attachment.name.size() > kNameSizeMax) return;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes of a text
  const auto* text = reinterpret_cast<const char*>(attachment.data.data());
  attachments_.insert_or_assign(std::string{attachment.name},
                                std::string_view{text, attachment.data.size()});
}

void SessionReader::keep(const McapMetadata& metadata) {
  metadata_size_ += kEntrySize + metadata.name.size();
  for (const auto& [key, value] : metadata.entries) {
    metadata_size_ += kEntrySize + key.size() + value.size();
  }
  if (metadata_size_ > kMetadataSizeMax) return;
  if (metadata.name == "palp.session") {
    if (sessions_.size() < kSessionsMax) {
      sessions_.push_back({.id = value_of(metadata.entries, "session_id"),
                           .number = value_of(metadata.entries, "session_number"),
                           .began_utc = value_of(metadata.entries, "began_utc")});
    }
    return;
  }
  if (metadata.name == "palp") {
    const std::string ahead = value_of(metadata.entries, kWallClockKey);
    std::int64_t value{};
    const auto [stop, error] = std::from_chars(ahead.data(), ahead.data() + ahead.size(), value);
    if (error == std::errc{} && stop == ahead.data() + ahead.size()) clock_.ahead = Duration{value};
  }
  metadata_.insert_or_assign(std::string{metadata.name}, metadata.entries);
}

void SessionReader::look_at_order(TopicCount& topic,
                                  const McapMessage& message,
                                  TimePoint at) const {
  if (window_) {
    if (message.log_time < window_->from || message.log_time > window_->to) return;
    if (!topic.looked_at) topic.sequence = SequenceCount{message.sequence};
  }
  const bool tick = message.channel->topic.ends_with("/tick");
  if (tick && topic.looked_at && at < topic.last) ++topic.dated_back;
  topic.sequence.see(message.sequence);
  topic.looked_at = true;
}

void SessionReader::count(const McapMessage& message) {
  TopicCount& topic = topics_[message.channel->topic];
  const TimePoint at = clock_.own(message.publish_time);
  if (topic.messages == 0) {
    topic.schema = message.schema == nullptr ? "" : message.schema->name;
    topic.first = at;
  }
  look_at_order(topic, message, at);
  topic.last = at;
  ++topic.messages;
  began_at_ = began_at_ ? std::min(*began_at_, at) : at;
  ended_at_ = ended_at_ ? std::max(*ended_at_, at) : at;
}

std::optional<SessionEntry> SessionReader::decode(const McapMessage& message) {
  const std::string_view topic = message.channel->topic;
  const bool surgeon = topic.starts_with("surgeon/");
  if (message.schema == nullptr || message.channel->message_encoding != "protobuf" ||
      !(surgeon || topic.starts_with("patient/"))) {
    ++unknown_;
    return std::nullopt;
  }
  using Verdict = SessionDecoder::Verdict;
  const Verdict verdict = SessionDecoder::decode(
      message.schema->name, message.payload, clock_.own(message.publish_time), parts_);
  parts_of_ = surgeon ? link::Role::Surgeon : link::Role::Patient;
  if (const auto part = parts_.take()) return SessionEntry{.site = parts_of_, .record = *part};
  if (verdict == Verdict::Unknown) {
    ++unknown_;
  } else if (verdict == Verdict::Malformed && malformed_++ == 0) {
    first_malformed_ = std::string{topic} + " number " + std::to_string(message.sequence);
  }
  return std::nullopt;
}

std::uint64_t SessionReader::missing() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& [name, topic] : topics_) sum += topic.sequence.missing();
  return sum;
}

std::uint64_t SessionReader::disordered() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& [name, topic] : topics_) sum += topic.sequence.disordered();
  return sum;
}

std::uint64_t SessionReader::dated_back() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& [name, topic] : topics_) sum += topic.dated_back;
  return sum;
}

std::optional<std::string> SessionReader::metadata(std::string_view record,
                                                   std::string_view key) const {
  const auto found = metadata_.find(record);
  if (found == metadata_.end()) {
    return std::nullopt;
  }
  const auto entry = std::find_if(found->second.begin(),
                                  found->second.end(),
                                  [&](const auto& pair) { return pair.first == key; });
  return entry == found->second.end() ? std::nullopt : std::optional{entry->second};
}

McapMap SessionReader::metadata(std::string_view record) const {
  const auto found = metadata_.find(record);
  return found == metadata_.end() ? McapMap{} : found->second;
}

std::optional<std::string_view> SessionReader::attachment(std::string_view name) const {
  const auto found = attachments_.find(name);
  return found == attachments_.end() ? std::nullopt : std::optional{found->second};
}

}  // namespace palp::record
