#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/result.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/io/endpoint.h"
#include "netem/passage.h"
#include "netem/simulation.h"

namespace palp::netem {

/// A datagram as it crossed one of the relay's sockets.
struct CapturedDatagram {
  static constexpr std::size_t kBytesMax = 1472;
  TimePoint at{};
  std::uint8_t side{};  ///< 0: the client's, 1: the server's
  bool outbound{};      ///< the relay sent it
  std::uint8_t tos{};
  std::uint32_t length{};                  ///< [bytes] of payload, also when not all of it was kept
  std::array<std::byte, kBytesMax> bytes;  ///< left as it is beyond `length`
};

/// What the relay's thread tells the recording. `final`: nothing more comes of this datagram.
struct RecordedDecision {
  Decision decision;
  Direction direction{};
  std::uint8_t copies{};  ///< of a whole datagram as decided, told before its copies; 0: a release
  bool final{};
};

/// Two queues from the relay's thread to whoever writes. Thread: written by the relay, read by the
/// writer. When a queue is full the item is counted, not waited for.
class RecordingQueue {
 public:
  RecordingQueue();
  void decided(std::span<const Decision> decisions, Direction direction, bool final) noexcept;
  void left(const Decision& decision, Direction direction) noexcept;
  void crossed(std::span<const std::byte> bytes,
               TimePoint at,
               std::uint8_t side,
               bool outbound,
               std::uint8_t tos) noexcept;

  SpscQueue<RecordedDecision> decisions;
  SpscQueue<CapturedDatagram> datagrams;
  /// Set by the writer before it opens its files, and cleared when it has closed them.
  std::atomic<bool> wanted{false};
  std::atomic<std::uint64_t> missed{0};
};

/// The files PREFIX-up.csv, PREFIX-down.csv (columns of `palp-netem simulate`, and the length) and
/// PREFIX.pcapng (both sides as two interfaces). The CSV is complete and can be replayed; it tells
/// the decisions, not the machine's lateness. Thread: the writer's.
class RecordingWriter {
 public:
  struct Sides {
    io::Endpoint client_side;  ///< the relay's own address towards the client
    io::Endpoint server_side;  ///< ... and towards the server
    io::Endpoint server;
  };
  /// `start`: 0 of the CSVs' times; `wall_start` its time since 1970.
  RecordingWriter(RecordingQueue& queue, TimePoint start, Duration wall_start);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  [[nodiscard]] Result<void> open(const std::string& prefix, const Sides& sides);
  [[nodiscard]] bool is_open() const noexcept { return files_ != nullptr; }
  /// Writes what waits. `client`: who the relay's client is now.
  void drain(const io::Endpoint& client);
  [[nodiscard]] Result<void> close();

 private:
  struct Files;
  void write(const CapturedDatagram& datagram, const io::Endpoint& client);

  RecordingQueue& queue_;
  TimePoint start_;
  Duration wall_start_;
  std::unique_ptr<Files> files_;
};

}  // namespace palp::netem
