#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/process/descriptor.h"
#include "netem/model/impaired_path.h"
#include "netem/model/simulation.h"

namespace palp::netem {

/// An address and a port as they stand in headers.
struct CapturedEnd {
  std::array<std::byte, 16> address{};
  std::uint8_t size{};  ///< [bytes] of the address: 4 or 16; 0: nobody
  std::uint16_t port{};

  CapturedEnd() noexcept = default;
  explicit CapturedEnd(const io::Endpoint& endpoint) noexcept;
};

/// Where a datagram crosses: one of the relay's sockets and who is on the other side of it.
struct Crossing {
  CapturedEnd own;
  CapturedEnd peer;
  std::uint8_t side{};  ///< 0: the client's, 1: the server's
};

/// A datagram as it crossed one of the relay's sockets.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): bytes are not touched in vain
struct CapturedDatagram {
  static constexpr std::size_t kBytesMax = 1472;
  TimePoint at{};
  Crossing crossing;  ///< as it was then
  bool outbound{};    ///< the relay sent it
  std::uint8_t tos{};
  std::uint32_t length{};                  ///< [bytes] of payload, also when not all of it was kept
  std::array<std::byte, kBytesMax> bytes;  ///< left as it is beyond `length`
};

/// What the relay's thread tells the recording: of a datagram as decided each copy, and, where that
/// left its release open, the release.
struct RecordedDecision {
  Decision decision;
  Direction direction{};
  std::uint8_t copies{};  ///< of the whole datagram, original included; 0: a release
};

/// What a recording lacks.
struct RecordingGaps {
  std::uint64_t missed{};  ///< told while a queue was full
  std::uint64_t open{};    ///< on their way at its end: the release is the one first thought of
};

/// Two queues from the relay's thread to whoever writes. Thread: written by the relay, read by the
/// writer. When a queue is full the item is counted, not waited for.
class RecordingQueue {
 public:
  RecordingQueue();
  void decided(std::span<const Decision> decisions, Direction direction) noexcept;
  void left(const Decision& decision, Direction direction) noexcept;
  void crossed(const Crossing& crossing,
               std::span<const std::byte> bytes,
               TimePoint at,
               bool outbound,
               std::uint8_t tos) noexcept;

  SpscQueue<RecordedDecision> decisions;
  SpscQueue<CapturedDatagram> datagrams;
  /// Set by the writer before it opens its files, and cleared when it has closed them.
  std::atomic<bool> wanted{false};
  std::atomic<std::uint64_t> missed{0};
};

/// Makes a file to write to, or says why not.
using OpenFile = std::function<Result<io::Descriptor>(const std::string& path)>;
/// What stands there already is gone.
[[nodiscard]] Result<io::Descriptor> open_over(const std::string& path);

/// The files PREFIX-up.csv, PREFIX-down.csv (columns of `palp-netem simulate`, and the length) and
/// PREFIX.pcapng (both sides as two interfaces). The CSV is complete and can be replayed: it counts
/// from its first datagram, and tells the decisions, not the machine's lateness.
/// Thread: the writer's.
class RecordingWriter {
 public:
  /// `start`: 0 of the CSVs' times; `wall_start` its time since 1970.
  RecordingWriter(RecordingQueue& queue, TimePoint start, Duration wall_start);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// Where one of the three cannot be had, those before it stay behind empty.
  [[nodiscard]] Result<void> open(const std::string& prefix, const OpenFile& open_file = open_over);
  [[nodiscard]] bool is_open() const noexcept { return files_ != nullptr; }
  /// Writes what waits.
  void drain();
  /// Writes the rest.
  [[nodiscard]] Result<RecordingGaps> close();

 private:
  struct Files;
  void write(const RecordedDecision& told);
  void write(const CapturedDatagram& captured);

  RecordingQueue& queue_;
  TimePoint start_;
  Duration wall_start_;
  std::unique_ptr<Files> files_;
};

}  // namespace palp::netem
