#include "netem/relay_recording.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

#include "common/link/transport.h"
#include "netem/pcapng.h"

namespace palp::netem {
namespace {

constexpr std::size_t kDecisionsMax = 65'536;
constexpr std::size_t kDatagramsMax = 8'192;
constexpr std::size_t kFlushAt = std::size_t{1} << 16U;  ///< [bytes]

/// The address and port of an endpoint as they stand in headers.
struct RawAddress {
  std::vector<std::byte> address;
  std::uint16_t port{};
};

RawAddress raw(const io::Endpoint& endpoint) {
  RawAddress result;
  result.port = endpoint.port();
  if (endpoint.family() == AF_INET6) {
    sockaddr_in6 six{};
    std::memcpy(&six, endpoint.address(), sizeof six);
    result.address.resize(16);
    std::memcpy(result.address.data(), &six.sin6_addr, 16);
  } else {
    sockaddr_in four{};
    if (endpoint.valid()) std::memcpy(&four, endpoint.address(), sizeof four);
    result.address.resize(4);
    std::memcpy(result.address.data(), &four.sin_addr, 4);
  }
  return result;
}

}  // namespace

RecordingQueue::RecordingQueue() : decisions{kDecisionsMax}, datagrams{kDatagramsMax} {}

void RecordingQueue::decided(std::span<const Decision> all,
                             Direction direction,
                             bool final) noexcept {
  for (const Decision& decision : all) {
    const RecordedDecision told{decision, direction, static_cast<std::uint8_t>(all.size()), final};
    if (!decisions.try_enqueue(told)) missed.fetch_add(1, std::memory_order_relaxed);
  }
}

void RecordingQueue::left(const Decision& decision, Direction direction) noexcept {
  if (!decisions.try_enqueue({decision, direction, 0, true})) {
    missed.fetch_add(1, std::memory_order_relaxed);
  }
}

void RecordingQueue::crossed(std::span<const std::byte> bytes,
                             TimePoint at,
                             std::uint8_t side,
                             bool outbound,
                             std::uint8_t tos) noexcept {
  CapturedDatagram captured;
  captured.at = at;
  captured.side = side;
  captured.outbound = outbound;
  captured.tos = tos;
  captured.length = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(captured.bytes.data(), bytes.data(), std::min(bytes.size(), captured.bytes.size()));
  if (!datagrams.try_enqueue(captured)) missed.fetch_add(1, std::memory_order_relaxed);
}

struct RecordingWriter::Files {
  explicit Files(TimePoint start)
      : up{[this, start](const Decision& one) { append(one, start, up_text, up_file); }},
        down{[this, start](const Decision& one) { append(one, start, down_text, down_file); }} {}

  static void append(const Decision& one, TimePoint start, std::string& text, std::ofstream& file) {
    append_recording_line(text, one, start);
    text += ',' + std::to_string(one.length + kFrameHeaders) + '\n';
    if (text.size() > kFlushAt) flush(text, file);
  }
  static void flush(std::string& text, std::ofstream& file) {
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
  }

  std::ofstream up_file;
  std::ofstream down_file;
  std::ofstream capture_file;
  std::string up_text;
  std::string down_text;
  std::string capture;
  DecisionOrder up;
  DecisionOrder down;
  std::vector<Decision> gathered;  ///< copies of the datagram that is being told
  Sides sides;
};

RecordingWriter::RecordingWriter(RecordingQueue& queue, TimePoint start, Duration wall_start)
    : queue_{queue}, start_{start}, wall_start_{wall_start} {}

RecordingWriter::~RecordingWriter() { (void)close(); }

Result<void> RecordingWriter::open(const std::string& prefix, const Sides& sides) {
  if (files_) return fail("a recording is on already");
  auto files = std::make_unique<Files>(start_);
  const auto open_one = [](std::ofstream& file, const std::string& path) -> Result<void> {
    file.open(path, std::ios::binary | std::ios::trunc);
    if (!file) return fail("cannot write '" + path + "'");
    return {};
  };
  if (auto opened = open_one(files->up_file, prefix + "-up.csv"); !opened) return opened;
  if (auto opened = open_one(files->down_file, prefix + "-down.csv"); !opened) return opened;
  if (auto opened = open_one(files->capture_file, prefix + ".pcapng"); !opened) return opened;
  files->up_text = files->down_text = std::string{kRecordingHeader} + ",length\n";
  append_section_header(files->capture);
  append_interface(files->capture, "client side");
  append_interface(files->capture, "server side");
  files->sides = sides;
  files_ = std::move(files);
  queue_.wanted.store(true, std::memory_order_release);
  return {};
}

void RecordingWriter::drain(const io::Endpoint& client) {
  RecordedDecision told;
  while (queue_.decisions.try_dequeue(told)) {
    if (!files_) continue;
    DecisionOrder& order = told.direction == Direction::Up ? files_->up : files_->down;
    if (told.copies == 0) {
      order.left(told.decision);
      continue;
    }
    files_->gathered.push_back(told.decision);
    if (files_->gathered.size() < told.copies) continue;
    order.decided(files_->gathered, told.final);
    files_->gathered.clear();
  }
  CapturedDatagram captured;
  while (queue_.datagrams.try_dequeue(captured)) {
    if (files_) write(captured, client);
  }
}

void RecordingWriter::write(const CapturedDatagram& captured, const io::Endpoint& client) {
  const Sides& sides = files_->sides;
  const RawAddress own = raw(captured.side == 0 ? sides.client_side : sides.server_side);
  const RawAddress peer = raw(captured.side == 0 ? client : sides.server);
  const RawAddress& from = captured.outbound ? own : peer;
  const RawAddress& to = captured.outbound ? peer : own;
  if (from.address.size() != to.address.size()) return;  // a client of another family, or none yet
  const std::size_t kept = std::min<std::size_t>(captured.length, captured.bytes.size());
  append_datagram(files_->capture,
                  captured.side,
                  wall_start_ + (captured.at - start_),
                  captured.outbound,
                  {from.address, to.address, from.port, to.port},
                  captured.tos,
                  std::span{captured.bytes}.first(kept));
  if (files_->capture.size() > kFlushAt) Files::flush(files_->capture, files_->capture_file);
}

Result<void> RecordingWriter::close() {
  queue_.wanted.store(false, std::memory_order_release);
  if (!files_) return {};
  Files::flush(files_->up_text, files_->up_file);
  Files::flush(files_->down_text, files_->down_file);
  Files::flush(files_->capture, files_->capture_file);
  bool whole = true;
  for (std::ofstream* file : {&files_->up_file, &files_->down_file, &files_->capture_file}) {
    file->close();
    whole = whole && !file->fail();
  }
  files_.reset();
  if (!whole) return fail("the recording could not be written whole");
  return {};
}

}  // namespace palp::netem
