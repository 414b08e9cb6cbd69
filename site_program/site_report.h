#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/core/histogram.h"
#include "common/io/realtime/periodic_loop.h"
#include "common/link/session.h"
#include "common/link/telegram.h"
#include "site_program/exit_status.h"
#include "site_program/recording.h"

namespace palp::site_program {

/// Round trips as a program saw them at the rate of its display.
class RoundTrips {
 public:
  void add(const LinkHealth& link) noexcept;
  [[nodiscard]] std::optional<Duration> median() const noexcept;
  [[nodiscard]] std::optional<Duration> least() const noexcept { return least_; }
  /// As the link was when it last knew the peer's clock: after its session it forgets it.
  [[nodiscard]] const std::optional<LinkHealth>& clocked() const noexcept { return clocked_; }

 private:
  std::optional<LinkHealth> clocked_;
  Histogram all_;
  std::optional<Duration> least_;
};

/// The account of a site's run, for scripts (schema palp.site/2).
struct SiteReport {
  std::string site;  ///< "surgeon" or "patient"
  ExitStatus exit_status{config::ExitCode::CannotOpen, "cannot start", ""};
  std::uint64_t seed{};
  std::string coupling;
  std::string session_file;
  io::LoopStats loop;
  RecordAccount records;
  LinkHealth link;              ///< of the last tick
  link::SessionCounters noise;  ///< what came to the port besides data
  RoundTrips round_trips;
  std::uint64_t sessions{};
  std::optional<std::uint64_t> estimates;  ///< the patient's
  Duration estimate_p50{};  ///< from the sample that showed a reversal to the estimate
  Duration estimate_max{};
};

[[nodiscard]] std::string to_json(const SiteReport& report);
/// The same without what became of the records: for the session file itself.
[[nodiscard]] std::string figures_of(const SiteReport& report);

/// A run whose recording failed did not do all that it was asked for, however well it went: Done
/// becomes Missed, and the reason says so. Other endings stay and say it too.
[[nodiscard]] ExitStatus with_recording(ExitStatus exit_status, const RecordAccount& records);

/// The last thing a program does: says why it ended, writes the report (`path` empty: none).
/// @returns what main() returns.
[[nodiscard]] int finish(const SiteReport& report, const std::string& path);

}  // namespace palp::site_program
