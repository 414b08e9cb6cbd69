#pragma once

#include <algorithm>
#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/message/record.h"
#include "video/camera.h"
#include "video/standing_delay.h"

namespace palp::site_program {

/// What video knows of force.
struct ForceSeen {
  std::uint64_t session_id{};  ///< 0: none
  TimePoint began_at{};        ///< of that session, on our line
  LinkState link{};
  Duration round_trip{};  ///< 0: not known
  Duration way{};         ///< of telegrams to this site; 0: not known
  Duration peer_ahead{};  ///< peer's time - ours, each since the session began
  bool peer_clock{};      ///< that is known
  video::StandingDelay::Reading telegrams{};

  /// `since`: of the peer's session. Where its clock is not known yet the picture counts as new.
  [[nodiscard]] TimePoint own_line(Duration since, TimePoint now) const noexcept {
    return peer_clock ? std::min(now, began_at + since - peer_ahead) : now;
  }
};

/// Reads of a site's records what its video must know of force, so that rt has no part in it.
/// Thread: record; the mailboxes' readers are the video's.
class ForceWatch {
 public:
  /// Each record that the session file gets, in the same order.
  void take(const Record& record) noexcept;
  /// After all that waited was taken.
  void tell() noexcept { seen_box_.put(seen_); }

  [[nodiscard]] Mailbox<ForceSeen>& seen() noexcept { return seen_box_; }
  [[nodiscard]] Mailbox<video::TipSeen>& tip() noexcept { return tip_box_; }

 private:
  void hear(const Incoming& incoming) noexcept;

  ForceSeen seen_;
  bool measured_{};  ///< the peer's clock, by the link; else it is guessed from half a round trip
  video::StandingDelay standing_;
  TimePoint read_at_{};
  Mailbox<ForceSeen> seen_box_;
  Mailbox<video::TipSeen> tip_box_;
};

}  // namespace palp::site_program
