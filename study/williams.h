#pragma once

#include <cstddef>
#include <vector>

namespace palp::study {

/// Orders of `conditions` >= 1 conditions in which each follows each other equally often, and
/// stands at each place equally often (Williams 1949): `conditions` rows, twice as many if odd and
/// above 1. Participant p takes row p modulo their number. Pure.
[[nodiscard]] std::vector<std::vector<std::size_t>> williams_square(std::size_t conditions);

}  // namespace palp::study
