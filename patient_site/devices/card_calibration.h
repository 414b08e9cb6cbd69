#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace palp::patient {

/// A straight line from raw values to calibrated ones.
struct RawLine {
  double slope{1};  ///< [-]
  double offset{};  ///< [counts]
};

/// Three references of one range as the card measured them when it was made: pairs of raw value x
/// and target value y, both in counts. Without the negative one (EEPROM version 1.0) through two.
struct CardReferences {
  double ground_x{};                ///< [counts]
  double ground_y{};                ///< [counts]
  double plus_x{};                  ///< [counts]
  double plus_y{};                  ///< [counts]
  std::optional<double> minus_x{};  ///< [counts]
  double minus_y{};                 ///< [counts]
};

/// The least-squares line through them; nullopt where they lie in one place, or are no numbers.
[[nodiscard]] std::optional<RawLine> line_through(const CardReferences& references) noexcept;

/// Ranges of a USB-1608FS by their number: its full scale, and the table of references it uses.
struct CardRange {
  double full_scale{};           ///< [V]
  double table_full_scale{};     ///< [V]
  std::uint16_t plus_at{};       ///< address of the + reference, f32
  std::uint16_t minus_at{};      ///< of the - reference, f32
  std::uint16_t pairs_at{};      ///< of 8 pairs: offset u16, + gain u16
  std::uint16_t minus_raw_at{};  ///< of 8 - gains, u16
};
inline constexpr std::uint16_t kGroundReferenceAt = 0x90;
[[nodiscard]] const std::array<CardRange, 8>& card_ranges() noexcept;

/// What y a reference of `volts` [V] has in a range. [counts]
[[nodiscard]] double target_of(double volts, const CardRange& range) noexcept;
/// [V] of a calibrated value.
[[nodiscard]] double volts_of(double calibrated, const CardRange& range) noexcept;

}  // namespace palp::patient
