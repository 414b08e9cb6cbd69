#include "netem/relay/relay_recording.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "common/link/transport.h"
#include "netem/relay/pcapng.h"

namespace palp::netem {
namespace {

constexpr std::size_t kDecisionsMax = 65'536;
constexpr std::size_t kDatagramsMax = 8'192;
constexpr std::size_t kFlushAt = std::size_t{1} << 16U;  ///< [bytes]

/// More datagrams than can be on their way each wait for nothing: a release was missed.
constexpr std::size_t kDisorderMax = 262'144;

}  // namespace

CapturedEnd::CapturedEnd(const io::Endpoint& endpoint) noexcept : port{endpoint.port()} {
  if (!endpoint.valid()) return;
  if (endpoint.family() == AF_INET6) {
    sockaddr_in6 six{};
    std::memcpy(&six, endpoint.address(), sizeof six);
    size = 16;
    std::memcpy(address.data(), &six.sin6_addr, size);
  } else {
    sockaddr_in four{};
    std::memcpy(&four, endpoint.address(), sizeof four);
    size = 4;
    std::memcpy(address.data(), &four.sin_addr, size);
  }
}

RecordingQueue::RecordingQueue() : decisions{kDecisionsMax}, datagrams{kDatagramsMax} {}

void RecordingQueue::decided(std::span<const Decision> all, Direction direction) noexcept {
  for (const Decision& decision : all) {
    const RecordedDecision told{decision, direction, static_cast<std::uint8_t>(all.size())};
    if (!decisions.try_enqueue(told)) missed.fetch_add(1, std::memory_order_relaxed);
  }
}

void RecordingQueue::left(const Decision& decision, Direction direction) noexcept {
  if (!decisions.try_enqueue({decision, direction, 0})) {
    missed.fetch_add(1, std::memory_order_relaxed);
  }
}

void RecordingQueue::crossed(const Crossing& crossing,
                             std::span<const std::byte> bytes,
                             TimePoint at,
                             bool outbound,
                             std::uint8_t tos) noexcept {
  CapturedDatagram captured;
  captured.at = at;
  captured.crossing = crossing;
  captured.outbound = outbound;
  captured.tos = tos;
  captured.length = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(captured.bytes.data(), bytes.data(), std::min(bytes.size(), captured.bytes.size()));
  if (!datagrams.try_enqueue(captured)) missed.fetch_add(1, std::memory_order_relaxed);
}

struct RecordingWriter::Files {
  /// A file, and whether it took everything.
  struct Out {
    void write(std::string& text) {
      for (std::string_view left = text; whole && !left.empty();) {
        const ssize_t taken = ::write(descriptor.number(), left.data(), left.size());
        if (taken < 0 && errno == EINTR) continue;
        whole = taken > 0;
        if (whole) left.remove_prefix(static_cast<std::size_t>(taken));
      }
      text.clear();
    }
    io::Descriptor descriptor;
    bool whole{true};
  };
  /// The CSV of one direction.
  struct Way {
    explicit Way(TimePoint start)
        : order{[this, start](const Decision& one) { append(one, start); }} {}
    Way(const Way&) = delete;
    Way& operator=(const Way&) = delete;
    ~Way() = default;

    void append(Decision one, TimePoint start) {
      if (!first) first = one.index;
      one.index -= *first;
      append_recording_line(text, one, start);
      text += ',' + std::to_string(one.length + kFrameHeaders) + '\n';
      if (text.size() > kFlushAt) file.write(text);
    }
    /// All that is known of a datagram as decided.
    void tell_gathered() {
      if (gathered.empty()) return;
      order.decided(gathered);
      gathered.clear();
      if (order.waiting() > kDisorderMax) given_up += order.give_up(1);
    }

    Out file;
    std::string text;
    std::optional<std::uint64_t> first;  ///< which datagram is number 0 of the file
    std::vector<Decision> gathered;      ///< copies of the datagram that is being told
    std::uint64_t given_up{};
    DecisionOrder order;
  };

  explicit Files(TimePoint start) : up{start}, down{start} {}

  Way up;
  Way down;
  Out capture_file;
  std::string capture;
  std::uint64_t missed_before{};
};

Result<io::Descriptor> open_over(const std::string& path) {
  io::Descriptor file{::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
  if (!file.valid()) return fail("cannot write '" + path + "'");
  return file;
}

RecordingWriter::RecordingWriter(RecordingQueue& queue, TimePoint start, Duration wall_start)
    : queue_{queue}, start_{start}, wall_start_{wall_start} {}

RecordingWriter::~RecordingWriter() { (void)close(); }

Result<void> RecordingWriter::open(const std::string& prefix, const OpenFile& open_file) {
  if (files_) return fail("a recording is on already");
  drain();  // what was told after the last one's end
  auto files = std::make_unique<Files>(start_);
  const auto open_one = [&](Files::Out& file, const std::string& path) -> Result<void> {
    auto opened = open_file(path);
    if (!opened) return tl::unexpected<Error>(opened.error());
    file.descriptor = *std::move(opened);
    return {};
  };
  if (auto opened = open_one(files->up.file, prefix + "-up.csv"); !opened) return opened;
  if (auto opened = open_one(files->down.file, prefix + "-down.csv"); !opened) return opened;
  if (auto opened = open_one(files->capture_file, prefix + ".pcapng"); !opened) return opened;
  files->up.text = files->down.text = std::string{kRecordingHeader} + ",length\n";
  append_section_header(files->capture);
  append_interface(files->capture, "client side");
  append_interface(files->capture, "server side");
  files->missed_before = queue_.missed.load(std::memory_order_relaxed);
  files_ = std::move(files);
  queue_.wanted.store(true, std::memory_order_release);
  return {};
}

void RecordingWriter::drain() {
  RecordedDecision told;
  while (queue_.decisions.try_dequeue(told)) {
    if (files_) write(told);
  }
  CapturedDatagram captured;
  while (queue_.datagrams.try_dequeue(captured)) {
    if (files_) write(captured);
  }
}

void RecordingWriter::write(const RecordedDecision& told) {
  Files::Way& way = told.direction == Direction::Up ? files_->up : files_->down;
  if (told.copies == 0) return way.order.left(told.decision);
  // Of a datagram whose last copies were missed the next one is the first to tell.
  const bool other = !way.gathered.empty() && way.gathered.front().index != told.decision.index;
  if (other) way.tell_gathered();
  way.gathered.push_back(told.decision);
  if (way.gathered.size() >= told.copies) way.tell_gathered();
}

void RecordingWriter::write(const CapturedDatagram& captured) {
  const auto& [own, peer, side] = captured.crossing;
  const CapturedEnd& from = captured.outbound ? own : peer;
  const CapturedEnd& to = captured.outbound ? peer : own;
  if (from.size != to.size) return;  // a client of another family, or none yet
  const std::size_t kept = std::min<std::size_t>(captured.length, captured.bytes.size());
  append_datagram(files_->capture,
                  side,
                  wall_start_ + (captured.at - start_),
                  captured.outbound,
                  {std::span{from.address}.first(from.size),
                   std::span{to.address}.first(to.size),
                   from.port,
                   to.port},
                  captured.tos,
                  std::span{captured.bytes}.first(kept));
  if (files_->capture.size() > kFlushAt) files_->capture_file.write(files_->capture);
}

Result<RecordingGaps> RecordingWriter::close() {
  queue_.wanted.store(false, std::memory_order_release);
  if (!files_) return RecordingGaps{};
  drain();
  RecordingGaps gaps{.missed =
                         queue_.missed.load(std::memory_order_relaxed) - files_->missed_before};
  bool whole = true;
  for (Files::Way* way : {&files_->up, &files_->down}) {
    way->tell_gathered();
    gaps.open += way->given_up + way->order.give_up();
    way->file.write(way->text);
    whole = whole && way->file.whole;
  }
  files_->capture_file.write(files_->capture);
  whole = whole && files_->capture_file.whole;
  files_.reset();
  if (!whole) return fail("the recording could not be written whole");
  return gaps;
}

}  // namespace palp::netem
