#pragma once

#include <array>

namespace palp::fem {

/// Gauss-Legendre with five points: place between -1 and 1, and weight. Exact to the ninth power;
/// for what is less smooth than an element's own fields.
inline constexpr std::array<std::array<double, 2>, 5> kGaussFive{
    {{-0.9061798459386640, 0.2369268850561891},
     {-0.5384693101056831, 0.4786286704993665},
     {0, 0.5688888888888889},
     {0.5384693101056831, 0.4786286704993665},
     {0.9061798459386640, 0.2369268850561891}}};

}  // namespace palp::fem
