#include "common/io/secure/admission.h"

#include <algorithm>

namespace palp::io {

bool Admission::open_to(const Endpoint& from, TimePoint now) {
  while (!begun_.empty() && now - begun_.front().at >= std::chrono::seconds{1}) begun_.pop_front();
  if (begun_.size() >= kOfAll) return false;
  const auto of_host =
      std::ranges::count_if(begun_, [&](const Begun& one) { return one.from.same_host(from); });
  return static_cast<std::size_t>(of_host) < kOfOneHost;
}

void Admission::note(const Endpoint& from, TimePoint now) { begun_.push_back({from, now}); }

}  // namespace palp::io
