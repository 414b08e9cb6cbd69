#include "common/io/realtime/background_loop.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>

#include "common/io/realtime/realtime.h"
#include "common/io/realtime/steady_clock.h"

namespace palp::io {

/// How the thread came to its end. Who comes last frees it: the loop, or a thread left to itself.
struct BackgroundLoop::Ending {
  std::mutex mutex;
  std::condition_variable_any changed;
  bool ended{};
  bool left_to_itself{};
  std::exception_ptr failure;

  /// @returns that nobody else is there any more.
  bool run(const std::stop_token& stop,
           Duration pause,
           const std::function<void(TimePoint now)>& work) {
    const SteadyClock clock;
    std::exception_ptr thrown;
    try {
      for (bool last = false; !last;) {
        last = stop.stop_requested();
        work(clock.now());
        std::unique_lock lock{mutex};
        changed.wait_for(lock, stop, pause, [] { return false; });
      }
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock{mutex};
    ended = true;
    failure = thrown;
    changed.notify_all();
    return left_to_itself;
  }
};

BackgroundLoop::BackgroundLoop(const std::string& name,
                               Duration pause,
                               std::function<void(TimePoint now)> work)
    : ending_{std::make_unique<Ending>()},
      thread_{[ending = ending_.get(), name, pause, work = std::move(work)](
                  const std::stop_token& stop) {
        name_this_thread(name);
        const std::unique_ptr<Ending> mine{ending->run(stop, pause, work) ? ending : nullptr};
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
  if (ending_ && ending_->failure) {
    std::rethrow_exception(ending_->failure);
  }
}

bool BackgroundLoop::stop_within(Duration patience) {
  if (!thread_.joinable()) return true;
  thread_.request_stop();
  {
    std::unique_lock lock{ending_->mutex};
    if (!ending_->changed.wait_for(lock, patience, [&] { return ending_->ended; })) {
      ending_->left_to_itself = true;
      lock.unlock();
      thread_.detach();
      (void)ending_.release();  // the thread's own now
      return false;
    }
  }
  stop();
  return true;
}

std::optional<std::string> BackgroundLoop::failure() const {
  const std::lock_guard lock{ending_->mutex};
  if (!ending_->failure) return std::nullopt;
  try {
    std::rethrow_exception(ending_->failure);
  } catch (const std::exception& thrown) {
    return thrown.what();
  } catch (...) {
    return "an unknown fault";
  }
}

}  // namespace palp::io
