#pragma once

#include <cstdint>
#include <optional>

#include "common/core/lapse.h"
#include "common/core/time.h"
#include "common/core/user_command.h"
#include "common/link/telegram.h"
#include "common/record/link_events.h"
#include "common/record/notes.h"
#include "common/record/recorder.h"

namespace palp::record {

/// What a site has done so far. Counts never fall.
struct SiteCounts {
  std::uint64_t ticks{};
  std::uint64_t ticks_missed{};
  std::uint64_t records{};          ///< handed to the recorder and taken
  std::uint64_t records_lost{};     ///< refused by it
  std::uint64_t samples_limited{};  ///< of the law, sent within the limits of the wire
};

struct SiteAccountConfig {
  Duration period{std::chrono::milliseconds{1}};  ///< > 0
  Duration link_status_every{std::chrono::milliseconds{100}};
};

/// A site's account of its ticks: how much time passed in each, and all that is written down of
/// it. The same at both sites. Thread: rt. The recorder outlives it.
class SiteAccount {
 public:
  SiteAccount(const SiteAccountConfig& config, Recorder& recorder) noexcept;

  /// A tick begins. @returns the time since the one before: a whole number of periods, so that a
  /// law's filters keep their step. What a clock jumps ahead is not told from a late tick.
  [[nodiscard]] Lapse begin_tick(TimePoint now) noexcept;
  [[nodiscard]] const SiteCounts& counts() const noexcept { return counts_; }

  /// What the law tells its peer, as it can be sent.
  [[nodiscard]] PortSample within_limits(PortSample sample) noexcept;
  void record(const Record& record) noexcept;
  void note(NoteCode code, double detail = 0) noexcept;
  /// A decision of the site's supervisor; nothing is recorded where the reason is None.
  void transition(SiteState from, SiteState to, NoteCode reason) noexcept;
  void arrived(const link::Arrivals& arrivals) noexcept;
  /// Once a tick: its events, and its status at times.
  void link(const LinkHealth& health) noexcept;
  /// Once a tick: one's own devices in the first, the peer's where a session has begun or ended.
  void devices(const DeviceFacts& own, const DeviceFacts& peer, bool peer_changed) noexcept;
  /// Once a tick; recorded where it changes.
  void user(const UserCommand& command) noexcept;
  /// Once a tick, last.
  void heard(const LinkHealth& health,
             const link::Arrivals& arrivals,
             std::uint32_t depth_number) noexcept;

 private:
  [[nodiscard]] bool first_tick() const noexcept { return counts_.ticks <= 1; }

  SiteAccountConfig config_;
  Recorder& recorder_;
  SiteCounts counts_;
  TimePoint now_{};
  LinkEvents link_events_;
  std::optional<TimePoint> link_recorded_at_;
  UserCommand user_;
};

}  // namespace palp::record
