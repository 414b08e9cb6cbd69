#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/link/codec_control.h"
#include "common/link/header.h"
#include "common/link/telegram.h"

namespace palp::link {

struct SessionConfig {
  Role role{};
  std::uint64_t settings_hash{};  ///< of everything both sites must agree on
  std::string coupling;
  std::string git;  ///< for people
  /// Ours. The peer looks at those of our role; until said otherwise they are the simulated ones.
  DeviceFacts devices{HandFacts{}, StageFacts{}, ForceSensorFacts{}};
  std::uint32_t protocol_version{kProtocolVersion};
  Duration repeat_first{std::chrono::milliseconds{100}};
  Duration repeat_max{std::chrono::seconds{1}};
  double repeat_growth{1.5};  ///< [-], of the wait after each
};

/// Both sites know each other: make a LinkUpdate of this. Numbers start at 0.
struct Established {
  std::uint64_t session_id{};          ///< the same at both sites, never used before
  std::uint32_t send_connection{};     ///< of the peer
  std::uint32_t receive_connection{};  ///< ours
  std::uint64_t peer_session_id{};
  std::string peer_git;
  DeviceFacts peer_devices{};  ///< each number within its range
};
/// No session came about. `final`: and none will with these settings (the surgeon stops asking).
struct Refused {
  std::string text;
  bool final{};
};
/// The session is over: hand over an empty LinkUpdate.
struct Closed {
  std::string text;
};
using SessionEvent = std::variant<Established, Refused, Closed>;

/// What a Session wants done after an input.
struct SessionOutput {
  std::vector<ControlBytes> datagrams;  ///< whole, with header; see Session for where they go
  std::optional<SessionEvent> event;
};

struct SessionCounters {
  std::uint64_t malformed{};  ///< breaks a rule of form
  std::uint64_t foreign{};    ///< nothing that belongs to a session of ours
};

/// Finds the peer and agrees on a session (STATES.md): the surgeon asks, the patient answers and
/// keeps no state for strangers. An id that a side draws serves one session only, so nothing of an
/// old session can count in a new one, and a restarted peer is a new session.
/// Pure: no socket, no clock, no entropy of its own. Plain: whoever can read the path can forge.
///
/// Datagrams that on_datagram() returns go to where that datagram came from; those of tick() and
/// close() go to the peer (the surgeon's: the configured address).
/// Thread: io, or the lab's. Allocates.
class Session {
 public:
  /// `entropy`: 64 random bits of this process; all ids are drawn from them.
  Session(SessionConfig config, std::uint64_t entropy);

  /// Any bytes: whatever arrived that is not of type data.
  [[nodiscard]] SessionOutput on_datagram(std::span<const std::byte> datagram, TimePoint now);
  /// At least every 20 ms. `state` and `link_session_id` as in the LinkHealth of our Link; what it
  /// says of another session than the present one is not counted.
  [[nodiscard]] SessionOutput tick(TimePoint now, LinkState state, std::uint64_t link_session_id);
  /// We leave: three equal Byes, because nobody confirms them. Afterwards nothing is answered.
  [[nodiscard]] SessionOutput close(std::string_view text);

  /// A Hello outside the order of tick(): to the peer of the present session, else to anybody.
  [[nodiscard]] ControlBytes greeting();
  /// Whether this is a Hello that carries both ids of the present session, which nobody knows who
  /// did not hear them.
  [[nodiscard]] bool speaks_of_present(std::span<const std::byte> datagram) const;

  [[nodiscard]] bool established() const noexcept { return present_.has_value(); }
  [[nodiscard]] std::uint64_t session_id() const noexcept;  ///< 0: none
  [[nodiscard]] const SessionCounters& counters() const noexcept { return counters_; }

 private:
  struct Pair {
    std::uint64_t own{};
    std::uint64_t peer{};
  };

  void on_hello(const Hello& hello, TimePoint now, SessionOutput& out);
  void answer_as_patient(const Hello& hello, TimePoint now, SessionOutput& out);
  void hear_as_surgeon(const Hello& hello, TimePoint now, SessionOutput& out);
  void on_bye(const Bye& bye, SessionOutput& out);
  void refuse(const Hello& hello,
              ByeReason reason,
              const std::string& text,
              TimePoint now,
              SessionOutput& out);
  void establish(const Hello& hello, SessionOutput& out);
  void forget_session();
  [[nodiscard]] std::optional<std::string> mismatch(const Hello& hello) const;
  [[nodiscard]] bool link_works() const noexcept;
  [[nodiscard]] bool ours(std::uint64_t id) const noexcept;
  [[nodiscard]] std::uint64_t fresh_id() noexcept;
  [[nodiscard]] std::uint64_t session_id_of(const Pair& pair) const noexcept;
  [[nodiscard]] ControlBytes hello_to(const Pair& pair);
  [[nodiscard]] ControlBytes framed(PacketType type, const ControlBytes& message);

  SessionConfig config_;
  std::uint64_t entropy_;
  std::uint64_t ids_drawn_{};
  std::uint64_t offered_;        ///< our id for the next session
  std::optional<Pair> present_;  ///< the session there is
  std::string peer_git_;
  LinkState link_state_{};               ///< of the present session
  bool link_has_session_{};              ///< our Link was seen in the present session
  bool stopped_{};                       ///< refused for good, or closed by us
  std::uint64_t last_refused_{};         ///< peer id of which people were told
  std::optional<TimePoint> refused_at_;  ///< when people were told last
  std::uint64_t next_number_{};          ///< of control datagrams
  std::optional<TimePoint> next_hello_at_;
  Duration repeat_{};
  SessionCounters counters_;
};

}  // namespace palp::link
