#include "lab/run/simulator.h"

#include <algorithm>
#include <utility>

#include "common/core/check.h"

namespace palp::lab {

// A second, not zero, so that code which takes a default TimePoint for "never" is found out.
Simulator::Simulator() : now_{std::chrono::seconds{1}} {}

void Simulator::every(const Ticker& ticker, std::function<void(TimePoint)> tick) {
  PALP_CHECK(ticker.period > Duration{0}, "a ticker needs a positive period");
  PALP_CHECK(ticker.phase >= Duration{0}, "a ticker starts now or later");
  entries_.push_back({now_ + ticker.phase, ticker.period, std::move(tick)});
}

void Simulator::run_for(Duration span) {
  const TimePoint end = now_ + span;
  while (true) {
    // A handful of tickers: a scan keeps ties in order of registration without any bookkeeping.
    const auto next =
        std::min_element(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
          return a.due < b.due;
        });
    if (next == entries_.end() || next->due >= end) break;
    now_ = next->due;
    next->due += next->period;
    next->tick(now_);
  }
  now_ = end;
}

}  // namespace palp::lab
