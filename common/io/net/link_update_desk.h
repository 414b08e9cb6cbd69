#pragma once

#include <cstddef>
#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/site_state.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/io/net/side_inbox.h"
#include "common/link/link.h"
#include "common/link/link_update.h"

namespace palp::io {

/// What io must know of the link on rt.
struct LinkGlance {
  LinkState state{};
  std::uint64_t session_id{};     ///< which session that is of; 0: none
  std::uint64_t newest_number{};  ///< of the telegrams of that session
  std::uint8_t key{};             ///< id of the keys under which the newest one came
  TimePoint peer_heard_at{};      ///< a telegram of the address that rt's socket is connected to
};

/// Where io and rt meet: sessions go to rt, what they replaced comes back to be freed, and both
/// learn what they must of each other. Outlives the server and the sockets it makes; rt has
/// stopped before it is destroyed.
class LinkUpdateDesk {
 public:
  /// io. @returns false: rt has not taken the earlier ones yet; `next` is left as it was.
  [[nodiscard]] bool offer(link::LinkUpdate&& next);
  /// rt, first thing in a tick: gives the link at most one LinkUpdate and tells io the link's
  /// state. Frees nothing.
  void serve(link::Link& link, TimePoint now) noexcept;
  /// io.
  void destroy_retired();
  /// io: the link in the newest tick.
  [[nodiscard]] LinkGlance link() noexcept { return glance_.get(); }

  /// Filled by rt's sockets, emptied by io.
  [[nodiscard]] SideInbox& inbox() noexcept { return inbox_; }

 private:
  static constexpr std::size_t kWaitingMax = 8;

  SpscQueue<link::LinkUpdate> offered_{kWaitingMax};  ///< writer: io, reader: rt
  SpscQueue<link::LinkUpdate> retired_{kWaitingMax};  ///< writer: rt, reader: io
  Mailbox<LinkGlance> glance_;                        ///< writer: rt, reader: io
  SideInbox inbox_;
};

}  // namespace palp::io
