#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/place.h"
#include "common/core/result.h"

namespace palp::judge {

/// The static law of the tissue that a session touched: force over indentation at some places.
class TissueTable {
 public:
  /// CSV with the columns x_mm, y_mm, d_mm, F_N, or as it was before there was a plane site (A or
  /// B), d_mm, F_N; lines that begin with # are comments.
  [[nodiscard]] static Result<TissueTable> parse(std::string_view csv);

  /// Of an indentation.
  struct Row {
    double indentation{};  ///< [m]
    double force{};        ///< [N]
  };
  /// One more curve, its rows rising, unless one is known at this place.
  void add(const Place& place, std::vector<Row> rows);

  /// [N] at indentation [m], linear between rows; nullopt: outside the table, or no curve is of
  /// this place.
  [[nodiscard]] std::optional<double> force(const Place& place, double indentation) const;

 private:
  struct Curve {
    Place place;
    std::vector<Row> rows;
  };
  std::vector<Curve> curves_;
};

}  // namespace palp::judge
