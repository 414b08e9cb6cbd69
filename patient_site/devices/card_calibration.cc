#include "patient_site/devices/card_calibration.h"

#include <cmath>

namespace palp::patient {
namespace {

constexpr double kMiddle = 0x8000;  // [counts], 0 V
constexpr double kHalf = 0x7FFF;    // [counts], full scale above it
constexpr double kWhole = 65'536;   // [counts]

}  // namespace

std::optional<RawLine> line_through(const CardReferences& references) noexcept {
  const double count = references.minus_x ? 3 : 2;
  const double minus_x = references.minus_x.value_or(0);
  const double minus_y = references.minus_x ? references.minus_y : 0;
  const double x = references.ground_x + references.plus_x + minus_x;
  const double y = references.ground_y + references.plus_y + minus_y;
  const double xx = references.ground_x * references.ground_x +
                    references.plus_x * references.plus_x + minus_x * minus_x;
  const double xy = references.ground_x * references.ground_y +
                    references.plus_x * references.plus_y + minus_x * minus_y;
  const double spread = count * xx - x * x;
  if (!std::isfinite(spread) || !std::isfinite(xy) || spread < 1) return std::nullopt;
  const double slope = (count * xy - x * y) / spread;
  if (!std::isfinite(slope)) return std::nullopt;
  return RawLine{.slope = slope, .offset = (y - slope * x) / count};
}

const std::array<CardRange, 8>& card_ranges() noexcept {
  static constexpr CardRange kTen{10, 10, 0x80, 0xA0, 0xB0, 0x130};
  static constexpr CardRange kFive{5, 5, 0x84, 0x9C, 0xD0, 0x140};
  static constexpr CardRange kTwo{2, 2, 0x88, 0x98, 0xF0, 0x150};
  static constexpr CardRange kOne{1, 1, 0x8C, 0x94, 0x110, 0x160};
  static const auto scaled = [](CardRange range, double full_scale) {
    range.full_scale = full_scale;
    return range;
  };
  static const std::array<CardRange, 8> all{kTen,
                                            kFive,
                                            scaled(kTwo, 2.5),
                                            kTwo,
                                            scaled(kOne, 1.25),
                                            kOne,
                                            scaled(kOne, 0.625),
                                            scaled(kOne, 0.3125)};
  return all;
}

double target_of(double volts, const CardRange& range) noexcept {
  return volts * kWhole / (2 * range.table_full_scale) + kMiddle;
}

double volts_of(double calibrated, const CardRange& range) noexcept {
  return (calibrated - kMiddle) * range.full_scale / kHalf;
}

}  // namespace palp::patient
