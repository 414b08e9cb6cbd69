#include "site_program/disk_forecast.h"

#include <algorithm>

namespace palp::site_program {
namespace {

/// Longer than any session; a rate near 0 must not leave the range of a Duration.
constexpr double kLongest = 1e7;  // [s]

}  // namespace

void DiskForecast::look(TimePoint now, std::uint64_t written, std::uint64_t room) noexcept {
  if (count_ > 0 && now - looks_[(count_ - 1) % kLooks].at < kLookEvery) return;
  looks_[count_ % kLooks] = {now, written, room};
  ++count_;
  const Look& first = looks_[count_ > kLooks ? count_ % kLooks : 0];
  if (now - first.at < kAtFirst) return;
  const double span = seconds(now - first.at);
  const double own = static_cast<double>(written - first.written) / span;
  const double others =
      first.room > room ? static_cast<double>(first.room - room) / span : 0;  // [bytes/s]
  const double rate = std::max(own, others);
  if (rate > 0) {
    left_ = from_seconds(std::min(static_cast<double>(room) / rate, kLongest));
  } else {
    left_.reset();
  }
}

}  // namespace palp::site_program
