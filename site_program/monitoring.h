#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/mailbox.h"
#include "common/core/pointer_report.h"
#include "common/core/spsc_queue.h"
#include "common/settings/site_settings.h"
#include "monitor/controls.h"
#include "monitor/server.h"
#include "site_program/camera_watching.h"
#include "site_program/recording.h"
#include "site_program/status_line.h"

namespace palp::site_program {

/// What clients of the monitor may reach of a site, besides looking on. Null: nothing.
struct MonitoredSite {
  Mailbox<std::uint32_t>* stops{};
  Mailbox<PointerReport>* pointer{};
  io::MediaDoor* media{};           ///< the patient's camera is looked through
  Mailbox<Duration>* touch_hold{};  ///< touch waits for the picture
  monitor::StudyScreen* study{};    ///< a participant of a study answers on the page
};

/// The live page of a site's session, and what its clients ask of the program. A page that cannot
/// be served is a sentence, and the session goes on without. Thread: main.
class Monitoring {
 public:
  using Facts = std::vector<std::pair<std::string, std::string>>;

  /// Serves nothing unless asked to. `facts`: what the page may say of the session. `recording`
  /// and `site` outlive it.
  Monitoring(const settings::MonitorSettings& settings,
             const Facts& facts,
             Recording& recording,
             std::optional<MonitoredSite> site);
  ~Monitoring();
  Monitoring(const Monitoring&) = delete;
  Monitoring& operator=(const Monitoring&) = delete;

  /// Empty: it serves, or was not asked to.
  [[nodiscard]] const std::string& fault() const noexcept { return fault_; }
  [[nodiscard]] std::uint16_t port() const noexcept { return server_ ? server_->port() : 0; }
  /// Of the page, with the right to control; empty: there is none.
  [[nodiscard]] std::string control_page() const;
  /// Says where the page is and who may do what there, or why there is none.
  void announce(StatusLine& line) const;
  /// Says once where the page has gone while the session goes on.
  void tell_news(StatusLine& line);
  /// Notes what clients asked for since the last call.
  void look(Recording& recording, TimePoint now);
  [[nodiscard]] std::uint32_t marks() const noexcept { return marks_; }
  [[nodiscard]] std::uint32_t resets() const noexcept { return resets_; }
  [[nodiscard]] bool end_asked() const noexcept { return end_asked_; }
  /// Nobody looks on any more. Idempotent.
  void stop();

 private:
  [[nodiscard]] std::string page_of(const std::string& token) const;

  static constexpr std::size_t kRequestsMax = 256;

  SpscQueue<monitor::Request> requests_{kRequestsMax};  ///< writer: monitor, reader: main
  monitor::Tokens tokens_;
  std::string fault_;
  monitor::CameraFeed camera_;
  std::unique_ptr<monitor::Server> server_;
  std::unique_ptr<CameraWatching> watching_;  ///< null: no picture is wanted
  std::uint32_t marks_{};
  std::uint32_t resets_{};
  bool end_asked_{};
  bool told_of_failure_{};
};

}  // namespace palp::site_program
