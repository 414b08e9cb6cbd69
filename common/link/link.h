#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/core/result.h"
#include "common/core/watchdog.h"
#include "common/link/clock_offset.h"
#include "common/link/codec.h"
#include "common/link/link_update.h"
#include "common/link/peer_clock.h"
#include "common/link/replay_window.h"
#include "common/link/telegram.h"

namespace palp::link {

struct LinkConfig {
  Duration period{std::chrono::milliseconds{1}};  ///< of send(), the same at both ends; >= 200 us
  WatchdogConfig watchdog{};
  Duration closed_after{std::chrono::seconds{30}};  ///< gap that ends the session
  Duration sync_time{std::chrono::seconds{2}};      ///< after the first accepted telegram: enough
  std::uint32_t sync_exchanges{8};                  ///< echoes that are enough
  Duration round_trip_max{std::chrono::milliseconds{2500}};  ///< above it, never Live
  Duration stale_after{std::chrono::milliseconds{200}};      ///< or half the least round trip
};

/// One end of the data plane: numbers, stamps and seals telegrams; opens, checks and sorts what
/// arrives; says how the link is (STATES.md). A bad datagram is counted, never trusted, never
/// fatal. Makes no session (session.h) and knows no law. Owns codec, transport and protection.
/// Thread: rt (its node's), after construction.
class Link {
 public:
  /// Throws std::invalid_argument for a period that it cannot serve.
  Link(const LinkConfig& config, std::unique_ptr<Codec> codec);

  /// Another session id starts a new session: numbers, windows, round trip and the peer's report
  /// begin anew, counters go on. The same id replaces only what is not null. Id 0 ends the session.
  /// A new session needs its own protection.
  /// @returns what was retired, to be freed off the rt thread.
  [[nodiscard]] LinkUpdate adopt(LinkUpdate next, TimePoint now) noexcept;
  /// Once per period. Without a session nothing happens.
  void send(const Telegram& telegram, TimePoint now) noexcept;
  /// Once per period, before send(): drains the transport within its budget.
  [[nodiscard]] Arrivals receive(TimePoint now) noexcept;
  [[nodiscard]] LinkHealth health(TimePoint now) const noexcept;
  /// Of the session's other site, as it said in the handshake; nothing where there is no session.
  [[nodiscard]] const DeviceFacts& peer_devices() const noexcept { return peer_devices_; }
  /// In spare time before a tick: walks once through what sending and receiving do, with a telegram
  /// that nobody gets, because code that was not run for a millisecond runs slowly. Changes
  /// nothing.
  void warm_up() noexcept;

 private:
  static constexpr std::size_t kHistory = 64;  ///< > the number distance of 10 ms
  static constexpr std::size_t kSamplesPerTelegram = 3;
  static constexpr std::size_t kOlder = 2;

  struct Sent {
    bool used{};
    std::uint64_t number{};
    std::uint32_t epoch{};
    TimePoint at{};
    PortSample sample;  ///< as later telegrams repeat it
  };

  /// How long the newest telegram of a tick, the peer's or ours, was on its way.
  struct WayTaken {
    Duration way{};
    Duration tick{};  ///< the peer's, since its session began
    TimePoint arrived_at{};
  };
  /// Of a tick. A bunch tells of many ticks of the peer; more than these say nothing more.
  struct WaysTaken {
    static constexpr std::size_t kMax = 16;
    std::array<WayTaken, kMax> there{};
    std::size_t count{};
    std::optional<WayTaken> here;
  };

  /// All that begins anew with a session.
  struct SessionState {
    TimePoint began_at{};
    std::uint64_t next_number{};
    std::uint32_t epoch_sent{};  ///< newest
    std::array<Sent, kHistory> history{};

    ReplayWindow received;      ///< datagrams
    std::uint8_t newest_key{};  ///< of the newest of them
    ReplayWindow handed_over;   ///< samples, repaired ones included
    PeerClock clock;
    ClockOffsetEstimator offset;
    WaysTaken ways;  ///< not yet told to `offset`
    bool heard{};    ///< the next four speak of the newest accepted telegram
    std::uint64_t newest_number{};
    std::uint64_t newest_sent_at_ns{};
    TimePoint newest_arrived_at{};
    SiteReport peer;
    TimePoint first_accepted_at{};
    std::uint64_t echo_ns{message::kNothingHeard};  ///< newest
    std::uint32_t exchanges{};
    bool synchronised{};
    std::size_t payload_kind{};  ///< newest that either side sent, but none
    void note_payload(const PortSample& sample) noexcept {
      if (sample.payload.index() != 0) payload_kind = sample.payload.index();
    }
  };

  struct Opened {
    std::uint64_t number{};
    std::uint8_t key{};
    std::size_t size{};  ///< [bytes] of plain_
  };

  void end_session() noexcept;
  [[nodiscard]] WireTelegram compose(const Telegram& telegram, TimePoint now) const noexcept;
  void attach_older(WireTelegram& wire, TimePoint now) const noexcept;
  void drain(TimePoint now) noexcept;
  [[nodiscard]] tl::expected<Opened, Rejection> open(std::span<const std::byte> datagram,
                                                     TimePoint now) noexcept;
  void count(Rejection rejection) noexcept;
  void take(const WireTelegram& wire, std::uint64_t number, TimePoint arrived_at) noexcept;
  void accept(const WireTelegram& wire, std::uint64_t number, TimePoint arrived_at) noexcept;
  void note_ways(TimePoint now) noexcept;
  void hand_over(const Incoming& incoming, std::uint32_t epoch) noexcept;
  void synchronise(TimePoint now) noexcept;
  [[nodiscard]] std::uint32_t epoch_wanted() const noexcept;
  [[nodiscard]] Duration gap(TimePoint now) const noexcept;
  [[nodiscard]] LinkState judge(TimePoint now) const noexcept;

  LinkConfig config_;
  std::uint64_t older_distance_;  ///< in numbers: 5 ms
  std::unique_ptr<Codec> codec_;
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<PacketProtection> protection_;
  std::uint32_t send_connection_{};
  std::uint32_t receive_connection_{};
  std::uint64_t session_id_{};
  DeviceFacts peer_devices_;
  SessionState session_state_;
  LinkHealth counters_;  ///< its counters only; `lost` of former sessions
  std::uint32_t accepted_now_{};
  std::vector<Incoming> samples_;                       ///< never beyond the reserved size
  std::array<std::byte, kDatagramSizeMax> datagram_{};  ///< the one being sent or received
  std::array<std::byte, kDatagramSizeMax> plain_{};     ///< its content
};

}  // namespace palp::link
