#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "common/core/result.h"

namespace palp::review {

/// The two places of a phantom: A is plain, B lies over the inclusion.
enum class Place : std::uint8_t { A, B };
inline constexpr double kPlaceBoundary = 5e-3;  ///< [m], lateral; below it lies A

[[nodiscard]] constexpr Place place_at(double lateral) noexcept {
  return lateral < kPlaceBoundary ? Place::A : Place::B;
}
[[nodiscard]] constexpr const char* to_string(Place place) noexcept {
  return place == Place::A ? "A" : "B";
}

/// The static law of the tissue that a session touched: force over indentation at each place.
class TissueTable {
 public:
  /// CSV with the columns site (A or B), d_mm, F_N; lines that begin with # are comments.
  [[nodiscard]] static Result<TissueTable> parse(std::string_view csv);

  /// [N] at indentation [m], linear between rows; nullopt: outside the table.
  [[nodiscard]] std::optional<double> force(Place place, double indentation) const;

 private:
  struct Row {
    double indentation{};  ///< [m]
    double force{};        ///< [N]
  };
  std::array<std::vector<Row>, 2> rows_;
};

}  // namespace palp::review
