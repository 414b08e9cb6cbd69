#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/io/net/link_update_desk.h"
#include "common/io/process/service_notice.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/secure/session_server.h"
#include "common/link/link.h"
#include "common/settings/site_settings.h"
#include "site_program/site_address.h"
#include "site_program/site_report.h"
#include "site_program/status_line.h"

namespace palp::site_program {

struct RunnerConfig {
  link::SessionConfig session;
  HostAndPort address;
  std::optional<MeetingPlace> meeting;  ///< then the surgeon has no other address
  settings::ProtectionSettings protection;
  io::TransportWrap wrap_transport;
  settings::LoopSettings loop;
  bool with_media{};  ///< the site has a thread for video
};

/// Runs a site in real time: the threads rt and io, and what lies between them. Thread: its
/// maker's.
class Runner {
 public:
  /// Reads the identity, if there is one; listens or calls. @throws std::runtime_error with one
  /// sentence.
  explicit Runner(const RunnerConfig& config);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// For the thread of the video, where there is one; it ends before this.
  [[nodiscard]] io::MediaDoor& media_door() noexcept { return door_; }
  [[nodiscard]] std::string local() const { return server_->local().to_string(); }
  /// Ticks from now on until stop(), which comes before the end of all that `tick` refers to and of
  /// the link.
  void start(link::Link& link, std::function<void(TimePoint now)> tick);
  /// What of real time was asked for and not granted, and what is wrong with the identity, in
  /// sentences.
  [[nodiscard]] std::vector<std::string> shortcomings() const;
  /// Into the file's metadata: what this site proves itself with.
  void describe_identity(record::SessionInfo& info) const;
  /// With whom the newest session is, once for each. Told by tell_news().
  [[nodiscard]] std::optional<io::PeerIdentity> take_peer() { return std::exchange(peer_, {}); }
  /// Tells people of sessions, and a service manager that the loop goes on. @returns the sentence
  /// if there will never be one.
  std::optional<std::string> tell_news(StatusLine& line);
  /// Why there was no session when one was tried last; empty: none was refused.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }
  [[nodiscard]] std::uint64_t sessions() const noexcept { return sessions_; }
  /// Says goodbye to the peer, then ends both threads. Idempotent.
  void stop(const std::string& why);
  /// The end of the ticks, where stop() was not reached.
  void halt() noexcept { rt_.reset(); }
  /// After stop(): loop, where it was started, and sessions.
  void account(SiteReport& report);

 private:
  settings::LoopSettings loop_;
  std::unique_ptr<io::Credentials> credentials_;  ///< null: plain datagrams
  io::LinkUpdateDesk desk_;
  io::MediaDoor door_;
  std::unique_ptr<io::SessionServer> server_;
  std::unique_ptr<io::PeriodicThread> rt_;
  io::ServiceNotice service_;
  std::uint64_t sessions_{};
  std::string refusal_;
  std::optional<io::PeerIdentity> peer_;
};

}  // namespace palp::site_program
