#pragma once

#include <cstdint>

#include "patient_site/phantom.h"

namespace palp::patient {

/// A tissue that nobody chose: two places, A and B, whose forces rise with the indentation and are
/// otherwise drawn from `seed`. One of five kinds: a power of the indentation, an exponential, a
/// stiff skin over soft tissue (it softens), a kink where a stiffer layer is met, two layers. At
/// 3 mm place A has 20 to 1,500 N/m (secant, log-uniform), B 1.1 to 2.5 times as much, in every
/// other tissue by another law of the same kind. Every other tissue lets go of 5 to 35 % of its
/// force within 0.5 to 5 s. Curves reach to 10 mm. No law of force is tuned on it.
[[nodiscard]] Phantom drawn_tissue(std::uint64_t seed);

}  // namespace palp::patient
