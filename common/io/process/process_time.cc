#include "common/io/process/process_time.h"

#include <ctime>

namespace palp::io {
namespace {

Duration time_on(clockid_t clock) noexcept {
  timespec time{};
  ::clock_gettime(clock, &time);
  return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
}

}  // namespace

ProcessTime process_time() noexcept {
  return {.cpu = time_on(CLOCK_PROCESS_CPUTIME_ID), .wall = time_on(CLOCK_MONOTONIC)};
}

}  // namespace palp::io
