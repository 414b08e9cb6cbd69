#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/place.h"
#include "common/core/result.h"

namespace palp::patient {

/// A phantom's file may be so long.
inline constexpr std::size_t kTextSizeMax = 4 << 20;  ///< [bytes]

/// One row of a force-displacement table.
struct ForceRow {
  double indentation{};  ///< [m]
  double force{};        ///< [N], >= 0
};

/// Static contact force F(d) of one place of a tissue: a monotone cubic through the rows
/// (Fritsch and Carlson 1980), exact at the rows, with a continuous derivative. Zero below d = 0
/// and never extrapolated: beyond the last row it keeps the last row's force.
/// A value; immutable, so any thread may read it. force() allocates nothing.
class ForceTable {
 public:
  /// The table of `rows`: at least 4, finite, indentation rising from >= 0, force >= 0. Where the
  /// first row lies deeper than 0, (0, 0) is put before it. The sentence of an error counts rows
  /// from 1.
  [[nodiscard]] static Result<ForceTable> make(std::vector<ForceRow> rows);

  [[nodiscard]] double force(double indentation) const noexcept;       ///< [m] -> [N]
  [[nodiscard]] double derivative(double indentation) const noexcept;  ///< [m] -> [N/m]
  /// True where force() only repeats the last row.
  [[nodiscard]] bool beyond(double indentation) const noexcept { return indentation > depth_max(); }
  [[nodiscard]] double depth_max() const noexcept { return rows_.back().indentation; }  ///< [m]
  [[nodiscard]] std::span<const ForceRow> rows() const noexcept { return rows_; }

 private:
  explicit ForceTable(std::vector<ForceRow> rows);
  [[nodiscard]] std::size_t interval(double indentation) const noexcept;

  std::vector<ForceRow> rows_;
  std::vector<double> slopes_;         ///< [N/m], at the rows
  std::vector<std::uint32_t> starts_;  ///< row at or before the left edge of each uniform cell
  double cells_per_metre_{};           ///< [1/m]
};

/// Reads a CSV table: `#` comment lines, then a header with at least `d_mm` and `F_N` (others are
/// ignored), then one row a line. `name` is put in front of an error's sentence, which names line,
/// column and reason.
[[nodiscard]] Result<ForceTable> parse_force_table(std::string_view text, std::string_view name);

/// A curve and where on a tissue it holds.
struct PlacedCurve {
  Place place;
  ForceTable table;
};

/// The same with columns `x_mm` and `y_mm` (either may be absent: 0) where there are any: rows of
/// one place follow each other, places lie kPlacesApart or more from each other within kPlaceMax,
/// and there are kPlacesMax of them at most. Without those columns one curve at `otherwise`.
[[nodiscard]] Result<std::vector<PlacedCurve>> parse_tissue_curves(std::string_view text,
                                                                   std::string_view name,
                                                                   const Place& otherwise);
inline constexpr std::size_t kPlacesMax = 64;  ///< a force stays a matter of microseconds
inline constexpr double kPlacesApart = 1e-3;   ///< [m]
inline constexpr double kPlaceMax = 0.25;      ///< [m], to all sides: half of a stage's travel

/// The same from a file.
[[nodiscard]] Result<std::vector<PlacedCurve>> load_tissue_curves(const std::string& path,
                                                                  const Place& otherwise);

}  // namespace palp::patient
