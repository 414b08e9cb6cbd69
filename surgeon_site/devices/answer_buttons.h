#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palp::surgeon {

/// Buttons of a device by which a participant of a study answers: the first one is the first
/// answer. Each is the number of a bit in the device's report of its buttons. A value.
class AnswerButtons {
 public:
  static constexpr std::size_t kMost = 8;  ///< as many as a trial has answers

  /// `buttons`: kMost at most; none: nobody answers by them.
  explicit AnswerButtons(std::vector<std::uint32_t> buttons = {}) : buttons_{std::move(buttons)} {}

  /// Those that are held, bit 0 the first answer. `report`: bytes, the lowest bit of the first is
  /// button 0; what lies beyond them is not held.
  [[nodiscard]] std::uint8_t held(std::span<const std::uint8_t> report) const noexcept {
    unsigned held = 0;
    for (std::size_t i = 0; i < buttons_.size(); ++i) {
      const std::size_t byte = buttons_[i] / 8;
      if (byte >= report.size()) continue;
      held |= ((unsigned{report[byte]} >> (buttons_[i] % 8)) & 1U) << i;
    }
    return static_cast<std::uint8_t>(held);
  }

 private:
  std::vector<std::uint32_t> buttons_;
};

}  // namespace palp::surgeon
