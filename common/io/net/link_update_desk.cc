#include "common/io/net/link_update_desk.h"

#include <utility>

namespace palp::io {

bool LinkUpdateDesk::offer(link::LinkUpdate&& next) {
  return offered_.try_enqueue(std::move(next));
}

void LinkUpdateDesk::serve(link::Link& link, TimePoint now) noexcept {
  // As long as io has not cleared the way back, nothing new is taken: rt must never free. Seen from
  // its writer, a queue is never longer than it tells.
  link::LinkUpdate next;
  if (retired_.size_approx() < kWaitingMax && offered_.try_dequeue(next)) {
    link::LinkUpdate retired = link.adopt(std::move(next), now);
    if (retired.transport != nullptr || retired.protection != nullptr) {
      (void)retired_.try_enqueue(std::move(retired));
    }
  }
  const LinkHealth health = link.health(now);
  glance_.put({.state = health.state,
               .session_id = health.session_id,
               .newest_number = health.newest_number,
               .key = health.key,
               .peer_heard_at = inbox_.peer_heard_at});
}

void LinkUpdateDesk::destroy_retired() {
  for (link::LinkUpdate retired; retired_.try_dequeue(retired);) {
    retired = {};
  }
}

}  // namespace palp::io
