#include "common/io/realtime/background_loop.h"

#include <condition_variable>
#include <mutex>
#include <utility>

#include "common/io/realtime/realtime.h"
#include "common/io/realtime/steady_clock.h"

namespace palp::io {

BackgroundLoop::BackgroundLoop(const std::string& name,
                               Duration pause,
                               std::function<void(TimePoint now)> work)
    : thread_{[this, name, pause, work = std::move(work)](const std::stop_token& stop) {
        name_this_thread(name);
        run(stop, pause, work);
      }} {}

BackgroundLoop::~BackgroundLoop() {
  thread_.request_stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void BackgroundLoop::stop() {
  thread_.request_stop();
  if (thread_.joinable()) {
    thread_.join();
  }
  if (failure_) {
    std::rethrow_exception(failure_);
  }
}

void BackgroundLoop::run(const std::stop_token& stop,
                         Duration pause,
                         const std::function<void(TimePoint now)>& work) {
  const SteadyClock clock;
  std::mutex mutex;
  std::condition_variable_any wake;
  try {
    for (bool last = false; !last;) {
      last = stop.stop_requested();
      work(clock.now());
      std::unique_lock lock{mutex};
      wake.wait_for(lock, stop, pause, [] { return false; });
    }
  } catch (...) {
    failure_ = std::current_exception();
  }
}

}  // namespace palp::io
