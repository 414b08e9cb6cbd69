#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/time.h"
#include "monitor/access.h"
#include "monitor/controls.h"
#include "monitor/feed.h"
#include "monitor/outbox.h"
#include "monitor/pilot.h"
#include "monitor/protocol.h"

namespace palp::monitor {

struct DeskConfig {
  link::Role site{};
  std::string program;  ///< "palp-surgeon"
  std::string run;      ///< another at each start
  /// What a client may know of the session before its first message: coupling, master, version.
  std::vector<std::pair<std::string, std::string>> facts{};
};

/// All clients at once, without a socket: who asked for what, what each is sent, and what of it is
/// asked of the site. Bytes of clients may be anything. Thread: monitor.
class Desk {
 public:
  static constexpr std::size_t kClientsMax = 32;
  static constexpr std::size_t kWaitingMax = 256 * 1024;  ///< [bytes], of one client
  static constexpr double kMessagesPerSecond = 120;       ///< [1/s], of one client, in the mean

  Desk(const DeskConfig& config, Controls controls);

  /// @returns its number, 1, 2, ...; 0: there are too many.
  [[nodiscard]] std::uint32_t join(Right right, TimePoint now);
  void leave(std::uint32_t client, TimePoint now);
  [[nodiscard]] std::size_t clients() const noexcept { return clients_.size(); }
  [[nodiscard]] Outbox& outbox(std::uint32_t client) { return clients_.at(client).outbox; }

  /// false: it is no client of ours any more, and is to be closed.
  [[nodiscard]] bool hear_text(std::uint32_t client, std::string_view text, TimePoint now);
  [[nodiscard]] bool hear_bytes(std::uint32_t client, std::string_view bytes, TimePoint now);
  /// An answer to a ping; the client is told how long it took.
  void heard_pong(std::uint32_t client, Duration round_trip, TimePoint now);
  /// A ping that has had no answer for so long: a round trip of at least that.
  void awaits_pong(std::uint32_t client, Duration age, TimePoint now);
  [[nodiscard]] std::uint32_t pilot() const noexcept { return pilot_.client(); }

  void publish(const LiveMessage& message);
  void publish(const LiveStatus& status);
  /// `stamp`: of the capture, ns since 1970.
  void publish(const video::CameraFrame& frame, std::uint64_t stamp);
  void publish(const VideoShown& shown, std::uint64_t stamp);
  /// What a study shows by now, where there is one; who comes late is told it too.
  void publish_study();

 private:
  struct Client {
    Right right{};
    Outbox outbox{kWaitingMax};
    std::map<std::uint32_t, std::uint32_t> subscriptions;  ///< of ids to channels
    std::uint32_t pointer_channel{};
    bool needs_key{};  ///< of the camera nothing else is of use to it
    bool publishes{};
    double budget{kMessagesPerSecond};  ///< [-], messages it may send at once
    TimePoint heard_at{};
    Duration told_way{};  ///< the round trip it was told of last
  };
  struct Kept {
    std::uint32_t channel{};
    std::uint64_t stamp{};
    std::string bytes;
  };

  static void keep(const LiveMessage& message, std::deque<Kept>& in, std::size_t most);
  [[nodiscard]] bool within_budget(Client& client, TimePoint now) noexcept;
  void subscribe(Client& client, const ClientText::Subscription& wanted);
  void hear_pointer(std::uint32_t number, std::string_view json, TimePoint now);
  void answer_call(std::uint32_t number, Client& client, const ClientBytes& call, TimePoint now);
  /// Empty: done. Else why not.
  [[nodiscard]] std::string serve(std::uint32_t number, const ClientBytes& call, TimePoint now);
  [[nodiscard]] std::string answer_study(const ClientBytes& call, TimePoint now);
  /// Empty: the program will hear of it. Else why not.
  [[nodiscard]] std::string ask(Request::Kind kind, std::uint32_t client);
  void want_pictures();
  void want_key(Client& client);
  void tell_way(Client& client, Duration round_trip);
  void end_press(Client& client, const std::optional<PointerReport>& report);
  void tell(Client& client, Level level, std::string_view sentence);
  static void send(Client& client,
                   std::uint32_t channel,
                   std::uint64_t stamp,
                   std::span<const std::byte> payload);
  void send(std::uint32_t channel, std::uint64_t stamp, std::span<const std::byte> payload);

  DeskConfig config_;
  Controls controls_;
  std::vector<Channel> channels_;
  std::vector<Service> services_;
  std::map<std::uint32_t, Client> clients_;
  std::uint32_t joined_{};
  std::uint32_t stops_{};
  Pilot pilot_;
  std::deque<Kept> kept_;   ///< events, depths and maps so far, for who comes late
  std::deque<Kept> cells_;  ///< of the newest stiffness map, likewise
  std::uint64_t told_{};    ///< stamp of the newest status
  CameraWish wish_;
  std::string study_;  ///< what a study shows, JSON; empty: nothing yet
};

}  // namespace palp::monitor
