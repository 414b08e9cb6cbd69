// Writes the first inputs of the targets log_file and log_message: fuzz_log_seeds CORPUS.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "common/record/mcap_writer.h"
#include "common/record/session_encoder.h"

namespace palp::record {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, std::span<const std::byte> bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream file{path, std::ios::binary};
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// One of each kind that a site writes.
std::vector<Record> records() {
  const TimePoint at{std::chrono::milliseconds{5}};
  SiteTick tick;
  tick.at = at;
  tick.state = SiteState::Engaged;
  tick.position = 1e-3;
  tick.sent.payload = WavePayload{.wave_integral = 0.5, .wave_energy = 0.25};
  Arrived arrived;
  arrived.at = at;
  arrived.incoming.number = 7;
  arrived.incoming.sample.payload = ModelPayload{.version = 1, .c = {1, 2, 3}};
  LinkStatus status;
  status.at = at;
  status.health.state = LinkState::Live;
  status.health.accepted = 100;
  DepthEstimate estimate;
  estimate.number = 1;
  estimate.hash = 0.07;
  DepthArrived depth;
  depth.at = at;
  depth.report.number = 1;
  const MapReport map{.number = 9, .places = 9, .depth = {7e-3, 6e-3, 8e-3}};
  return {tick,
          arrived,
          status,
          Note{.at = at, .code = 33, .detail = 1.5},
          Transition{.at = at, .from = SiteState::Parked, .to = SiteState::Clutched, .reason = 2},
          estimate,
          depth,
          HandReading{.at = at, .position = 1e-3, .place = {}, .script_phase = 2},
          StageReading{.at = at, .position = 1e-3, .place = {}},
          ForceReading{.at = at, .fresh = true, .force = 0.2},
          LinkHeard{.at = at, .state = LinkState::Live, .session_id = 5, .peer_place = {}},
          UserAsked{.at = at, .command = {.emergency_stop = true}},
          DevicesTold{.at = at, .facts = {HandFacts{}, StageFacts{}, ForceSensorFacts{}}},
          PlantTruth{.at = at, .phase_place = {}, .hand = 1e-3, .tip_place = {}},
          MapEstimate{.at = at, .report = map},
          MapArrived{.at = at, .report = map},
          MapCell{.at = at, .number = 9, .index = 3, .count = 9, .place = {}, .stiffness = 1.5}};
}

/// A tick with all that it was given.
template <class FileTick>
FileTick whole_tick() {
  FileTick whole;
  whole.tick.state = SiteState::Engaged;
  whole.gathered = true;
  whole.given.heard.state = LinkState::Live;
  whole.given.samples = 2;
  whole.given.earlier.incoming.number = 6;
  whole.given.arrived.incoming.number = 7;
  whole.given.arrived.incoming.sample.payload = TdpaPayload{.energy_in = 0.5};
  return whole;
}

void messages(const fs::path& corpus) {
  for (const link::Role site : {link::Role::Surgeon, link::Role::Patient}) {
    SessionEncoder encoder{site};
    const auto topics = topics_of(site);
    for (const Record& record : records()) {
      const auto prepared = encoder.prepare(record, 3);
      if (!prepared) continue;
      Bytes bytes(1 + prepared->size);
      const auto topic = std::find_if(topics.begin(), topics.end(), [&](const TopicFormat& format) {
        return format.topic == prepared->topic;
      });
      bytes[0] = static_cast<std::byte>(2 * (topic - topics.begin()) +
                                        (site == link::Role::Patient ? 1 : 0));
      encoder.store(bytes.data() + 1);
      const std::string name{site_name(site)};
      write(corpus / "log_message" / (name + "-" + std::to_string(record.index())), bytes);
    }
    const auto whole = site == link::Role::Surgeon ? encoder.prepare(whole_tick<SurgeonFileTick>())
                                                   : encoder.prepare(whole_tick<PatientFileTick>());
    Bytes bytes(1 + whole.size);  // ticks are the first topic
    bytes[0] = static_cast<std::byte>(site == link::Role::Patient ? 1 : 0);
    encoder.store(bytes.data() + 1);
    write(corpus / "log_message" / (std::string{site_name(site)} + "-whole"), bytes);
  }
}

/// A whole file of few messages; its schemas are named, not described, which keeps it small.
Bytes session_file(const McapOptions& options) {
  MemorySink sink;
  McapWriter writer{sink, options};
  SessionEncoder encoder{link::Role::Surgeon};
  std::map<Topic, std::uint16_t> channels;
  for (const TopicFormat& topic : topics_of(link::Role::Surgeon)) {
    const std::uint16_t schema = writer.add_schema(topic.schema, "protobuf", {});
    channels[topic.topic] = writer.add_channel(schema, topic.name, "protobuf");
  }
  writer.add_metadata("palp", {{"program", "fuzz"}});
  writer.add_attachment({.log_time = 1,
                         .create_time = 1,
                         .name = "config.textproto",
                         .media_type = "text/plain",
                         .data = std::as_bytes(std::span{"x: 1"})});
  std::uint32_t sequence = 0;
  for (const Record& record : records()) {
    const auto prepared = encoder.prepare(record, 0);
    if (!prepared) continue;
    const McapStamp stamp{.channel = channels.at(prepared->topic),
                          .sequence = sequence++,
                          .log_time = 5'000'000,
                          .publish_time = 5'000'000};
    encoder.store(writer.add_message(stamp, prepared->size));
  }
  writer.close();
  return {sink.bytes().begin(), sink.bytes().end()};
}

/// Takes the CRCs of the chunks away, so that a change inside of one is read, not refused.
Bytes without_chunk_crc(Bytes file) {
  std::size_t at = kMcapMagic.size();
  while (at + kMcapPrefixSize < file.size()) {
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + at + 1, sizeof length);
    if (file[at] == static_cast<std::byte>(McapOpcode::Chunk)) {
      constexpr std::size_t kCrcPlace = kMcapPrefixSize + 24;  // begin, end, size of the records
      std::memset(file.data() + at + kCrcPlace, 0, 4);
    }
    at += kMcapPrefixSize + length;
  }
  return file;
}

void files(const fs::path& corpus) {
  McapOptions options;
  write(corpus / "log_file" / "zstd", session_file(options));
  options.compression = McapCompression::None;
  write(corpus / "log_file" / "plain", session_file(options));
  options.definitions_in_chunks = true;
  options.message_index = options.summary_offsets = options.repeated_schemas = false;
  write(corpus / "log_file" / "no-crc", without_chunk_crc(session_file(options)));
  options.chunks = false;
  const Bytes loose = session_file(options);
  write(corpus / "log_file" / "no-chunks", loose);
  write(corpus / "log_file" / "cut", std::span{loose}.first(loose.size() * 2 / 3));
}

}  // namespace
}  // namespace palp::record

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_log_seeds CORPUS\n");
    return 2;
  }
  try {
    palp::record::messages(argv[1]);
    palp::record::files(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
