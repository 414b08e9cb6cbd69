#include "common/record/session_writer.h"

#include <numeric>
#include <span>

namespace palp::record {
namespace {

std::uint64_t stamp(TimePoint at) noexcept {
  return static_cast<std::uint64_t>(at.time_since_epoch().count());
}

}  // namespace

std::uint64_t SessionCounts::records() const noexcept {
  return std::accumulate(by_type.begin(), by_type.end(), std::uint64_t{0});
}

SessionWriter::SessionWriter(ByteSink& sink, const SessionInfo& info, const McapOptions& options)
    : mcap_{sink, options}, encoder_{info.site}, newest_now_{info.opened_at} {
  McapMap metadata{{"site", std::string{site_name(info.site)}}};
  metadata.insert(metadata.end(), info.metadata.begin(), info.metadata.end());
  mcap_.add_metadata("palp", metadata);
  for (const SessionAttachment& attachment : info.attachments) {
    mcap_.add_attachment(stamp(info.opened_at),
                         attachment.name,
                         attachment.media_type,
                         std::as_bytes(std::span{attachment.content}));
  }
  for (const TopicFormat& format : topics_of(info.site)) {
    const auto schema = mcap_.add_schema(format.schema, "protobuf", format.descriptors);
    channels_[static_cast<std::size_t>(format.topic)].id =
        mcap_.add_channel(schema, format.name, "protobuf");
  }
}

SessionWriter::~SessionWriter() { close(); }

bool SessionWriter::write(const Record& record, TimePoint now) {
  newest_now_ = now;
  if (const auto* tick = std::get_if<SiteTick>(&record)) {
    view(*tick, now);
  }
  const auto prepared = encoder_.prepare(record, dropped_);
  if (!prepared) {
    ++counts_.misplaced;
    return false;
  }
  if (!put(*prepared, now)) {
    return false;
  }
  ++counts_.by_type[record.index()];
  return true;
}

bool SessionWriter::put(const Prepared& prepared, TimePoint now) {
  Channel& channel = channels_[static_cast<std::size_t>(prepared.topic)];
  std::byte* place = mcap_.add_message({.channel = channel.id,
                                        .sequence = channel.sequence,
                                        .log_time = stamp(now),
                                        .publish_time = stamp(prepared.at)},
                                       prepared.size);
  if (place == nullptr) {
    return false;
  }
  if (mcap_.waiting() == 1) settled_ = counts_;  // all before are written
  ++channel.sequence;
  encoder_.store(place);
  return true;
}

void SessionWriter::view(const SiteTick& tick, TimePoint now) {
  if (view_.ticks > 0 && elapsed(view_.began_at, tick.at) >= kViewInterval) {
    write_view(now);
  }
  view_.add(tick);
}

void SessionWriter::write_view(TimePoint now) {
  if (put(encoder_.prepare(view_), now)) {
    ++counts_.views;
  }
  view_ = {};
}

void SessionWriter::flush_if_due(TimePoint now) {
  mcap_.flush_if_due(stamp(now));
  if (mcap_.waiting() == 0 && !failed()) settled_ = counts_;
}

void SessionWriter::close() {
  if (closed_) {
    return;
  }
  closed_ = true;
  if (view_.ticks > 0) {
    write_view(newest_now_);
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
