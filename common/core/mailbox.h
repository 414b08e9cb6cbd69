#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace palp {

/// Latest value, one writer, one reader, wait-free on both sides (triple buffer).
/// Name the two threads where you declare one.
template <class T>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<T>, "crosses threads by copy");

 public:
  /// Writer's thread only.
  void put(const T& value) noexcept {
    slots_[writing_] = value;
    const std::uint8_t previous =
        shared_.exchange(static_cast<std::uint8_t>(writing_ | kNew), std::memory_order_acq_rel);
    writing_ = previous & kIndexMask;
  }

  /// Reader's thread only. The newest value; before the first put a default one.
  [[nodiscard]] const T& get() noexcept {
    if ((shared_.load(std::memory_order_relaxed) & kNew) != 0) {
      const std::uint8_t previous = shared_.exchange(reading_, std::memory_order_acq_rel);
      reading_ = previous & kIndexMask;
    }
    return slots_[reading_];
  }

 private:
  static constexpr std::uint8_t kIndexMask = 3;
  static constexpr std::uint8_t kNew = 4;  ///< set while the shared slot is unread

  std::array<T, 3> slots_{};
  std::uint8_t writing_{0};              ///< writer's
  std::uint8_t reading_{1};              ///< reader's
  std::atomic<std::uint8_t> shared_{2};  ///< index between them, and kNew
};

}  // namespace palp
