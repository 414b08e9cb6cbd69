#include "common/io/secure/admission.h"

#include <algorithm>

namespace palp::io {

void Admission::forget(TimePoint now) {
  while (!begun_.empty() && now - begun_.front().at >= kMemory) begun_.pop_front();
}

bool Admission::open_to(const Endpoint& from, TimePoint now) {
  forget(now);
  std::size_t of_all = 0;
  std::size_t of_debtors = 0;
  std::size_t of_host = 0;
  bool debtor = false;
  // Newest first: a flood ends here soon.
  for (auto at = begun_.rbegin(); at != begun_.rend(); ++at) {
    const Begun& one = *at;
    const bool lately = now - one.at < kPause;
    if (!lately && debtor) break;
    of_all += lately ? 1 : 0;
    of_debtors += lately && one.by_debtor ? 1 : 0;
    if (!one.from.same_host(from)) continue;
    of_host += lately ? 1 : 0;
    debtor = debtor || !one.finished;
    if (lately && !one.finished) return false;
  }
  if (debtor && of_debtors >= kOfDebtors) return false;
  return of_host < kOfOneHost && of_all < kOfAll;
}

void Admission::note(const Endpoint& from, TimePoint now) {
  begun_.push_back({.from = from, .at = now, .by_debtor = debt(from) > 0});
}

void Admission::finished(const Endpoint& from) {
  for (Begun& one : begun_) one.finished = one.finished || one.from.same_host(from);
}

std::size_t Admission::debt(const Endpoint& from) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      begun_, [&](const Begun& one) { return !one.finished && one.from.same_host(from); }));
}

}  // namespace palp::io
