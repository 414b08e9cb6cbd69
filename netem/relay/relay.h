#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/histogram.h"
#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/io/net/datagram_socket.h"
#include "common/io/net/endpoint.h"
#include "netem/model/channel.h"
#include "netem/model/path_plan.h"
#include "netem/relay/client_choice.h"
#include "netem/relay/relay_recording.h"
#include "netem/relay/release_timing.h"

namespace palp::netem {

using io::DatagramSocket;
using io::kDatagramBatch;
using io::monotonic_now;
using io::OutgoingDatagram;
using io::ReceivedDatagram;
using io::wall_now;

struct RelayConfig {
  io::Endpoint listen;   ///< the surgeon's side
  io::Endpoint forward;  ///< the patient's
  PathPlan up{};         ///< surgeon to patient
  PathPlan down{};       ///< patient to surgeon
  std::uint64_t seed{1};
  std::size_t in_flight_max{65'536};  ///< datagrams each way: 1 s of delay at 65 kHz
  std::size_t datagram_max{1472};     ///< [bytes], what an Ethernet frame takes
  int priority{};                     ///< SCHED_FIFO 1..99 if permitted; 0: leave it as it is
  int stop_descriptor{-1};            ///< serve() ends when this becomes readable
};

/// Counted at the relay's sockets, beside the channel's own counters.
struct RelayTraffic {
  std::uint64_t forwarded{};      ///< sent on
  std::uint64_t unsent{};         ///< released, but nobody to send to, or refused by the kernel
  std::uint64_t late_releases{};  ///< sent more than 60 us after their time
  std::uint64_t socket_errors{};  ///< of the socket that this direction leaves by
  Histogram delay;                ///< from the kernel's arrival stamp to the end of the send call
  Histogram release_error;        ///< distance of the end of the send call from the time decided
};

/// A change from outside, and where it acts.
struct RelayCommand {
  PreparedChange change;
  Direction direction{};
  TimePoint at{};          ///< not before; on the way back: when it was applied
  std::string words;       ///< for the log
  std::uint64_t number{};  ///< the sender's own
};

/// What the relay shows while it runs. Of each direction, by Direction.
struct RelayStatus {
  struct Way {
    ChannelCounters counters;
    std::uint64_t forwarded{};
    std::uint64_t late_releases{};
    std::uint64_t socket_errors{};
    std::uint64_t changes{};
    std::size_t in_flight{};
    Duration delay_p50{};
    Duration delay_p99{};
    Duration error_p99{};
  };
  std::array<Way, 2> ways;
  TimePoint at{};
  io::Endpoint client;
};

/// The impaired path as a process: two UDP ports with a Channel for each direction between them.
/// Replies go to the client, which ClientChoice names, so a restarted surgeon with a new port
/// becomes it and a stranger does not. Video comes from another port of the surgeon's, and the
/// patient tells it from force by that: its datagrams have a client and a socket of their own, and
/// share the channels. A peer that vanishes is counted, nothing more.
/// Thread: the one that serves it; it asks the clock and waits in the kernel, but spins the last
/// 60 us before a release. commands, status and recording are the other thread's ends.
class Relay {
 public:
  /// @throws std::system_error when a socket cannot be opened.
  explicit Relay(const RelayConfig& config);

  /// Works for `span`, or until the stop descriptor is readable. @returns false: told to stop.
  bool serve(Duration span);

  [[nodiscard]] io::Endpoint listening_on() const { return client_side_.local(); }
  /// Where the patient sees us.
  [[nodiscard]] io::Endpoint forwarding_from() const { return server_side_[kForce].local(); }
  [[nodiscard]] const std::optional<io::Endpoint>& client() const noexcept {
    return clients_[kForce].client();
  }
  /// Once it has been served.
  [[nodiscard]] bool real_time() const noexcept { return real_time_; }
  [[nodiscard]] TimePoint start() const noexcept { return start_; }
  [[nodiscard]] const Channel& channel(Direction direction) const noexcept {
    return direction == Direction::Up ? up_ : down_;
  }
  [[nodiscard]] RelayTraffic traffic(Direction direction) const;

  /// Writer: the other thread. What comes back in `spent` is to be freed there. Few may wait here
  /// for their time: who has many sends each shortly before.
  SpscQueue<RelayCommand> commands{64};
  SpscQueue<RelayCommand> spent{64};
  /// Reader: the other thread. Renewed four times a second.
  Mailbox<RelayStatus> status;
  RecordingQueue recording;
  /// The laws that hold now, by Direction: ImpairedPath::law_number(). Writer: the relay's thread;
  /// renewed before a change comes back in `spent`.
  std::array<std::atomic<std::uint64_t>, 2> law_numbers{};

 private:
  struct Readable {
    bool client_side{};
    bool server_side{};
  };
  /// What leaves with one send call.
  struct Batch {
    std::array<Decision, kDatagramBatch> leaving;
    std::array<OutgoingDatagram, kDatagramBatch> outgoing;
  };

  void drain(Readable readable) noexcept;
  void push(Direction direction, std::span<const ReceivedDatagram> datagrams) noexcept;
  void take_commands(TimePoint now);
  void tell_laws(TimePoint now) noexcept;
  void release(Direction direction, TimePoint now) noexcept;
  std::size_t send(Direction direction, std::size_t count) noexcept;
  void account(Direction direction, std::size_t sent, TimePoint before) noexcept;
  void rebind_if_asked();
  [[nodiscard]] std::uint64_t socket_errors(Direction direction) const noexcept;
  [[nodiscard]] Crossing crossing(std::uint8_t side, std::size_t lane) const noexcept;
  [[nodiscard]] Duration lead(Direction direction, TimePoint next) const noexcept;
  [[nodiscard]] Readable rest(TimePoint now, TimePoint until) noexcept;
  void warm() noexcept;
  void show(TimePoint now) noexcept;
  [[nodiscard]] Channel& way(Direction direction) noexcept {
    return direction == Direction::Up ? up_ : down_;
  }

  /// By their first byte (WIRE.md), once a second client has sent such; all else is force's.
  static constexpr std::size_t kForce = 0;
  static constexpr std::size_t kVideo = 1;
  static constexpr std::size_t kLanes = 2;
  [[nodiscard]] std::size_t lane_of(std::span<const std::byte> datagram) const noexcept;

  DatagramSocket client_side_;
  std::array<DatagramSocket, kLanes> server_side_;
  io::Endpoint forward_;
  CapturedEnd client_end_;                       ///< of our socket
  std::array<CapturedEnd, kLanes> server_ends_;  ///< likewise
  TimePoint start_;
  Channel up_;
  Channel down_;
  int stop_descriptor_;
  int priority_;
  bool real_time_{};
  bool stopped_{};
  bool recording_on_{};
  std::uint64_t rebinds_{};
  std::array<ClientChoice, kLanes> clients_;
  std::vector<RelayCommand> waiting_;    ///< commands whose time has not come
  std::array<RelayTraffic, 2> traffic_;  ///< by Direction
  ReleaseTiming timing_;
  TimePoint show_at_{};
  Batch batch_;
};

}  // namespace palp::netem
