#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "judge/site.h"

namespace palp::judge {

/// The static law of the tissue that a session touched: force over indentation at each site.
class TissueTable {
 public:
  /// CSV with the columns site (A or B), d_mm, F_N; lines that begin with # are comments.
  [[nodiscard]] static Result<TissueTable> parse(std::string_view csv);

  /// [N] at indentation [m], linear between rows; nullopt: outside the table.
  [[nodiscard]] std::optional<double> force(Site site, double indentation) const;

 private:
  struct Row {
    double indentation{};  ///< [m]
    double force{};        ///< [N]
  };
  std::array<std::vector<Row>, 2> rows_;
};

}  // namespace palp::judge
