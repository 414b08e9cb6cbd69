#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace palp::test {

/// While alive, whatever a real-time thread must not do is a violation: allocate or free, take a
/// lock, wait, sleep, throw, open a file, read or write where that can block, print.
///
///     RealtimeGuard guard;
///     for (...) node.tick(now);
///     guard.release();
///     EXPECT_TRUE(guard.clean()) << guard.first_violation();
///
/// Watches its own thread only; guards nest, the innermost counts. Works by defining malloc and
/// the others in the test program (realtime_calls.cc), so whatever library calls them is seen;
/// calls that the C library makes inside itself are not.
class RealtimeGuard {
 public:
  /// False under the sanitizers, which bring their own malloc: the guard then sees nothing.
  static constexpr bool kArmed = PALP_REALTIME_GUARD_ARMED != 0;

  RealtimeGuard() noexcept;
  ~RealtimeGuard();
  RealtimeGuard(const RealtimeGuard&) = delete;
  RealtimeGuard& operator=(const RealtimeGuard&) = delete;

  /// Stops watching; idempotent. The findings stay.
  void release() noexcept;

  [[nodiscard]] bool clean() const noexcept { return count_ == 0; }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// The function called first and from where, for people; empty if clean.
  [[nodiscard]] std::string first_violation() const;

  /// For what a test does itself between two guarded calls. Scopes nest.
  class Pause {
   public:
    Pause() noexcept;
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    RealtimeGuard* paused_;
  };

  /// Counts a violation on this thread if a guard is alive here. For realtime_calls.cc and for
  /// fakes of slow things.
  static void violation(const char* function) noexcept;

 private:
  static constexpr int kFramesMax = 32;

  std::uint64_t count_{};
  const char* function_{""};  ///< of the first violation
  std::array<void*, kFramesMax> frames_{};
  int frame_count_{};
  RealtimeGuard* outer_;
  bool watching_{true};
};

}  // namespace palp::test
