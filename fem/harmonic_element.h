#pragma once

#include <array>

#include "fem/element.h"
#include "fem/material.h"

namespace palp::fem {

/// One harmonic of an element's displacements: those along r and z go as cos n phi, those along phi
/// as sin n phi. r of nine nodes, then z, then phi.
using HarmonicMatrix = std::array<std::array<double, 27>, 27>;

/// Stiffness of an element in the harmonic `order` >= 0, small strain; only the lower triangle is
/// filled. [N/m] Strains: Zienkiewicz and Taylor, The Finite Element Method for Solid and
/// Structural Mechanics, section on semi-analytical methods. The pressure is linear in the element
/// and eliminated, as in element.h. The integral round the axis is in it: 2 pi for order 0, pi for
/// the others. Thread: any.
[[nodiscard]] HarmonicMatrix harmonic_stiffness(const ElementGeometry& geometry,
                                                const Material& material,
                                                int order);

}  // namespace palp::fem
