#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace palp::plot {

/// What a figure is made for. All lengths are points, 1/72 inch.
struct Style {
  std::string_view name;
  double width{};         ///< [pt], of the whole figure
  double panel_height{};  ///< [pt], of a panel's axes
  double text{};          ///< [pt], size of the letters
  double line{};          ///< [pt], width of a curve
  bool titled{};          ///< the figure's title is drawn; a paper has a caption
};

inline constexpr double kPointsPerMillimetre = 72 / 25.4;  ///< [pt/mm]

/// A screen; one column of a journal's page, 85 mm; both columns, 175 mm. Letters of 8 points are
/// what journals ask for at least.
inline constexpr std::array kStyles{Style{"screen", 760, 350, 12, 2, true},
                                    Style{"single", 85 * kPointsPerMillimetre, 130, 8, 1, false},
                                    Style{"double", 175 * kPointsPerMillimetre, 170, 8, 1, false}};

/// The one of that name; nullopt: there is none.
[[nodiscard]] std::optional<Style> style_of(std::string_view name) noexcept;

}  // namespace palp::plot
