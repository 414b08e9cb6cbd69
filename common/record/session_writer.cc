#include "common/record/session_writer.h"

#include <cstring>
#include <numeric>
#include <span>

#include "common/record/log_line.h"
#include "common/record/said_twice.h"

namespace palp::record {
namespace {

/// Where the file and its stamps lie in the world's time.
void describe_clock(const SessionInfo& info, McapMap& metadata) {
  const WallClock& clock = info.clock;
  metadata.emplace_back("file_number", std::to_string(info.files_before + 1));
  metadata.emplace_back("began_utc", utc_text(clock.stamp(info.opened_at)));
  metadata.emplace_back("time_zone", clock.zone);
  metadata.emplace_back("clock_source", clock.source);
  metadata.emplace_back("clock_synchronised", clock.synchronised);
  metadata.emplace_back("clock_uncertainty_us", clock.uncertainty_us);
  metadata.emplace_back(kWallClockKey, std::to_string(clock.ahead.count()));
}

}  // namespace

std::uint64_t SessionCounts::records() const noexcept {
  return std::accumulate(by_type.begin(), by_type.end(), std::uint64_t{0});
}

SessionCounts& SessionCounts::operator+=(const SessionCounts& other) noexcept {
  for (std::size_t type = 0; type < by_type.size(); ++type) by_type[type] += other.by_type[type];
  views += other.views;
  log_lines += other.log_lines;
  foreign += other.foreign;
  misplaced += other.misplaced;
  return *this;
}

SessionWriter::SessionWriter(ByteSink& sink, const SessionInfo& info, const McapOptions& options)
    : mcap_{sink, options},
      encoder_{info.site},
      gatherer_{info.site},
      clock_{info.clock},
      sessions_{info.sessions_before} {
  McapMap metadata{{"site", std::string{site_name(info.site)}}};
  describe_clock(info, metadata);
  metadata.insert(metadata.end(), info.metadata.begin(), info.metadata.end());
  mcap_.add_metadata("palp", metadata);
  const std::uint64_t opened_at = clock_.stamp(info.opened_at);
  for (const SessionAttachment& attachment : info.attachments) {
    mcap_.add_attachment({.log_time = opened_at,
                          .create_time = opened_at,
                          .name = attachment.name,
                          .media_type = attachment.media_type,
                          .data = std::as_bytes(std::span{attachment.content})});
  }
  for (const TopicFormat& format : topics_of(info.site)) {
    const auto schema = mcap_.add_schema(format.schema, "protobuf", format.descriptors);
    channels_[static_cast<std::size_t>(format.topic)].id =
        mcap_.add_channel(schema, format.name, "protobuf");
  }
  const auto schema = mcap_.add_schema(kLogLineSchema, "protobuf", log_line_descriptors());
  log_channel_.id =
      mcap_.add_channel(schema, std::string{site_name(info.site)} + "/log", "protobuf");
}

SessionWriter::~SessionWriter() { close(); }

bool SessionWriter::write(const Record& record) {
  if (closed_) return false;
  if (const auto* tick = std::get_if<SiteTick>(&record)) {
    view(*tick);
  } else if (const auto* heard = std::get_if<LinkHeard>(&record)) {
    look_for_session(*heard);
  }
  if (gatherer_.stands_in_the_way_of(record)) release_tick();
  if (const auto first = gatherer_.crowded_out_by(record)) (void)write_alone(*first);
  if (!gatherer_.take(record)) return write_alone(record);
  return !gatherer_.whole() || write_tick();
}

template <class FileTick>
bool SessionWriter::put_whole(FileTick tick) {
  if (!leave_out(tick)) {
    release_tick();
    return true;
  }
  const bool written = put(encoder_.prepare(tick));
  if (written) {
    for (const Record& record : gatherer_.held()) ++counts_.by_type[record.index()];
  }
  gatherer_.clear();
  return written;
}

bool SessionWriter::write_tick() {
  const bool surgeon = gatherer_.site() == link::Role::Surgeon;
  return surgeon ? put_whole(gatherer_.surgeon()) : put_whole(gatherer_.patient());
}

void SessionWriter::release_tick() {
  for (const Record& record : gatherer_.held()) (void)write_alone(record);
  gatherer_.clear();
}

bool SessionWriter::write_alone(const Record& record) {
  const auto prepared = encoder_.prepare(record, dropped_);
  if (!prepared) {
    ++counts_.misplaced;
    return false;
  }
  if (!put(*prepared)) {
    return false;
  }
  ++counts_.by_type[record.index()];
  if (prepared->topic == Topic::Event) write_log_line(record, prepared->at);
  return true;
}

std::uint16_t SessionWriter::add_topic(const ForeignTopic& topic) {
  const auto schema = mcap_.add_schema(topic.schema, "protobuf", topic.descriptors);
  foreign_.push_back({.id = mcap_.add_channel(schema, topic.name, "protobuf")});
  return static_cast<std::uint16_t>(foreign_.size() - 1);
}

bool SessionWriter::write(std::uint16_t topic,
                          const Instants& at,
                          std::span<const std::byte> message) {
  if (closed_) return false;
  std::byte* place = place_for(
      foreign_.at(topic), clock_.stamp(at.logged), clock_.stamp(at.sample), message.size());
  if (place == nullptr) return false;
  std::memcpy(place, message.data(), message.size());
  ++counts_.foreign;
  return true;
}

void SessionWriter::add_facts(const std::string& name, const McapMap& facts) {
  if (!closed_) mcap_.add_metadata(name, facts);
}

void SessionWriter::look_for_session(const LinkHeard& heard) {
  if (heard.session_id == 0 || heard.session_id == session_id_ || closed_) return;
  session_id_ = heard.session_id;
  mcap_.add_metadata("palp.session",
                     {{"session_id", session_id_text(session_id_)},
                      {"session_number", std::to_string(++sessions_)},
                      {"began_utc", utc_text(clock_.stamp(heard.at))}});
}

bool SessionWriter::put(const Prepared& prepared) {
  Channel& channel = channels_[static_cast<std::size_t>(prepared.topic)];
  std::byte* place = place_for(channel, clock_.stamp(prepared.at), prepared.size);
  if (place == nullptr) return false;
  encoder_.store(place);
  return true;
}

std::byte* SessionWriter::place_for(Channel& channel,
                                    std::uint64_t logged,
                                    std::uint64_t published,
                                    std::size_t size) {
  std::byte* place = mcap_.add_message({.channel = channel.id,
                                        .sequence = channel.sequence,
                                        .log_time = logged,
                                        .publish_time = published},
                                       size);
  if (place == nullptr) return nullptr;
  if (mcap_.waiting() == 1) settled_ = counts_;  // all before are written
  ++channel.sequence;
  return place;
}

void SessionWriter::write_log_line(const Record& event, TimePoint at) {
  const auto line = log_line_of(event, gatherer_.site());
  if (!line) return;
  const std::uint64_t stamp = clock_.stamp(at);
  const Bytes bytes = log_line_bytes(*line, stamp);
  std::byte* place = place_for(log_channel_, stamp, bytes.size());
  if (place == nullptr) return;
  std::memcpy(place, bytes.data(), bytes.size());
  ++counts_.log_lines;
}

void SessionWriter::view(const SiteTick& tick) {
  if (view_.ticks > 0 && elapsed(view_.began_at, tick.at) >= kViewInterval) {
    write_view();
  }
  view_.add(tick);
}

void SessionWriter::write_view() {
  if (put(encoder_.prepare(view_))) {
    ++counts_.views;
  }
  view_ = {};
}

void SessionWriter::flush_if_due(TimePoint now) {
  mcap_.flush_if_due(clock_.stamp(now));
  if (mcap_.waiting() == 0 && !failed()) settled_ = counts_;
}

void SessionWriter::close() {
  if (closed_) {
    return;
  }
  closed_ = true;
  release_tick();
  if (view_.ticks > 0) {
    write_view();
  }
  McapMap summary{{"messages", std::to_string(messages())},
                  {"records", std::to_string(counts_.records())},
                  {"records_dropped", std::to_string(dropped_)},
                  {"records_misplaced", std::to_string(counts_.misplaced)}};
  for (std::size_t type = 0; type < kRecordNames.size(); ++type) {
    summary.emplace_back(kRecordNames[type], std::to_string(counts_.by_type[type]));
  }
  mcap_.add_metadata("palp.summary", summary);
  mcap_.close();
}

}  // namespace palp::record
