#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "patient_site/devices/device_profile.h"

/// Between SI and the words of registers: the only place that knows word orders.
namespace palp::patient {

/// Counts into one or two words; rounded, and held within the kind's range. NaN is 0.
[[nodiscard]] std::array<std::uint16_t, 2> to_words(double counts,
                                                    WordKind kind,
                                                    WordOrder order) noexcept;

/// Counts out of one or two words. An F32 may be NaN or infinite.
[[nodiscard]] double from_words(std::span<const std::uint16_t> words,
                                WordKind kind,
                                WordOrder order) noexcept;

/// The words of one read request, by the address of each.
class ReadWords {
 public:
  static constexpr std::size_t kCountMax = 125;

  /// `count` <= kCountMax.
  ReadWords(std::uint16_t address, std::size_t count) noexcept : address_{address}, count_{count} {}

  [[nodiscard]] std::span<std::uint16_t> words() noexcept { return {words_.data(), count_}; }
  /// All of the field lies within.
  [[nodiscard]] bool holds(std::uint16_t address, std::size_t words) const noexcept {
    return address >= address_ && address - address_ + words <= count_;
  }
  /// What holds() only.
  [[nodiscard]] std::uint16_t word(std::uint16_t address) const noexcept {
    return words_[static_cast<std::size_t>(address - address_)];
  }
  [[nodiscard]] double counts(const RegisterField& field, WordOrder order) const noexcept {
    const auto at = static_cast<std::size_t>(field.address - address_);
    const double counts =
        from_words(std::span{words_}.subspan(at, words_in(field.kind)), field.kind, order);
    return field.negative && meets(*field.negative) ? -counts : counts;
  }
  [[nodiscard]] bool meets(const RegisterCondition& condition) const noexcept {
    return (word(condition.address) & condition.mask) == condition.value;
  }

 private:
  std::uint16_t address_;
  std::size_t count_;
  std::array<std::uint16_t, kCountMax> words_{};
};

}  // namespace palp::patient
