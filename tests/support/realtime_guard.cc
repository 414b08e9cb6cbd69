#include "tests/support/realtime_guard.h"

#include <cstdlib>
#include <memory>
#include <span>
#include <string_view>

#include <cxxabi.h>
#include <execinfo.h>

#include "common/core/check.h"
#include "tests/support/realtime_calls.h"

namespace palp::test {
namespace {

/// The innermost guard of this thread that is not paused.
constinit thread_local RealtimeGuard* innermost = nullptr;

/// "program(_ZN4palp3fooEv+0x12) [0x55]" -> "palp::foo()"; what has no name stays as it is.
std::string readable(std::string_view frame) {
  const auto open = frame.find('(');
  const auto plus = frame.find('+', open == std::string_view::npos ? 0 : open);
  if (open == std::string_view::npos || plus == std::string_view::npos || plus <= open + 1) {
    return std::string{frame};
  }
  const std::string name{frame.substr(open + 1, plus - open - 1)};
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> plain{
      abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status), &std::free};
  return status == 0 ? std::string{plain.get()} : name;
}

}  // namespace

RealtimeGuard::RealtimeGuard() noexcept : outer_{innermost} {
  innermost = nullptr;
  // What loads its library or its symbols on first use does so now, not in the guarded code.
  backtrace(frames_.data(), kFramesMax);
  prepare_realtime_calls();
  innermost = this;
}

RealtimeGuard::~RealtimeGuard() { release(); }

void RealtimeGuard::release() noexcept {
  if (!watching_) return;
  PALP_CHECK(innermost == this, "guards end in the reverse order of their beginning");
  watching_ = false;
  innermost = outer_;
}

void RealtimeGuard::violation(const char* function) noexcept {
  RealtimeGuard* const guard = innermost;
  if (guard == nullptr) return;
  if (guard->count_++ > 0) return;
  innermost = nullptr;
  guard->function_ = function;
  guard->frame_count_ = backtrace(guard->frames_.data(), kFramesMax);
  innermost = guard;
}

std::string RealtimeGuard::first_violation() const {
  if (clean()) return {};
  const Pause pause;
  std::string text = std::string{function_} + ", called from";
  const std::unique_ptr<char*, decltype(&std::free)> names{
      backtrace_symbols(frames_.data(), frame_count_), &std::free};
  const std::span<char*> all{names.get(), static_cast<std::size_t>(frame_count_)};
  constexpr std::size_t kOwnFrames = 2;  // violation() and the watched function itself
  for (std::size_t i = kOwnFrames; i < all.size(); ++i) text += "\n  " + readable(all[i]);
  return text;
}

RealtimeGuard::Pause::Pause() noexcept : paused_{innermost} { innermost = nullptr; }
RealtimeGuard::Pause::~Pause() { innermost = paused_; }

}  // namespace palp::test
