#pragma once

#include <string>

#include "fem/curve.h"

namespace palp::fem {

/// The deformed section as a VTK unstructured grid (text), for ParaView: biquadratic cells with
/// `displacement_mm`, `material` and, at the nodes, the mean equivalent stress of their cells
/// `von_mises_kpa` (of the model's own stress measure). Lengths in millimetre, undeformed.
[[nodiscard]] std::string vtu_text(const Curve& curve, const Specimen& specimen, Model model);

}  // namespace palp::fem
