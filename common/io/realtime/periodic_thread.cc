#include "common/io/realtime/periodic_thread.h"

#include <future>
#include <utility>

namespace palp::io {

PeriodicThread::PeriodicThread(const std::string& name,
                               const LoopConfig& config,
                               std::function<void(TimePoint now)> tick,
                               std::function<void()> warm_up) {
  std::promise<RealtimeGrant> granted;
  std::future<RealtimeGrant> answer = granted.get_future();
  thread_ = std::jthread{[this,
                          name,
                          config,
                          tick = std::move(tick),
                          warm_up = std::move(warm_up),
                          granted = std::move(granted)](const std::stop_token& stop) mutable {
    name_this_thread(name);
    const LoopTaps taps{.granted = [&](const RealtimeGrant& grant) { granted.set_value(grant); },
                        .warm_up = std::move(warm_up),
                        .progress = &progress_};
    stats_ = run_periodic(config, tick, stop, taps);
  }};
  grant_ = answer.get();
}

PeriodicThread::~PeriodicThread() { stop(); }

const LoopStats& PeriodicThread::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  return stats_;
}

}  // namespace palp::io
