#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palp::link {

/// Remembers which of the last 1,024 numbers were seen. Looking and marking are separate, because
/// a number counts only once its datagram has proved authentic. A value. Thread: its owner's.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;

  enum class Verdict : std::uint8_t { New, Seen, TooOld };

  [[nodiscard]] Verdict judge(std::uint64_t number) const noexcept;
  /// Only after judge() said New. Forward jumps of any size cost at most kSize/64 steps.
  void mark(std::uint64_t number) noexcept;

  [[nodiscard]] bool empty() const noexcept { return marked_ == 0; }
  [[nodiscard]] std::uint64_t newest() const noexcept { return newest_; }  ///< 0 when empty
  [[nodiscard]] std::uint64_t marked() const noexcept { return marked_; }  ///< since the start
  /// Numbers from 0 to the newest that were never marked.
  [[nodiscard]] std::uint64_t missing() const noexcept {
    return empty() ? 0 : newest_ + 1 - marked_;
  }
  /// Bit k: number newest() - 1 - k was marked.
  [[nodiscard]] std::uint32_t before_newest() const noexcept;

 private:
  static constexpr std::uint64_t kWordBits = 64;
  static constexpr std::size_t kWords = kSize / kWordBits + 1;  ///< one to be cleared ahead

  [[nodiscard]] bool bit(std::uint64_t number) const noexcept;

  std::array<std::uint64_t, kWords> words_{};  ///< number n: word n/64 mod kWords, bit n mod 64
  std::uint64_t newest_{};
  std::uint64_t marked_{};
};

}  // namespace palp::link
