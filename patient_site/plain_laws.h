#pragma once

#include <optional>
#include <string_view>

#include "patient_site/force_table.h"
#include "patient_site/relaxation.h"

/// Tissues as laws of the force over the indentation, for checks of what no database holds.
namespace palp::patient {

/// [m] -> [N], from 0 on.
using PlainLaw = double (*)(double indentation) noexcept;

/// A law by its name in the words of a phantom.
struct NamedLaw {
  std::string_view name;
  PlainLaw force;
  Relaxation relaxation;
};
/// closed-form, exponential, relaxing, draining or layered; nullopt: no such law.
[[nodiscard]] std::optional<NamedLaw> plain_law(std::string_view name);

/// What a bonded layer `height` [m] thick adds to the force of a half space under a tip of 5 mm:
/// the series of Dimitriadis and others 2002 for an incompressible layer. [-], above 1; within
/// about 1 % where the tip is less than half as deep as the layer is thick.
[[nodiscard]] double bonded_layer_factor(double indentation, double height) noexcept;

/// Tabulated so finely that the table stands for the law (relative difference below 1e-5 from
/// 0.05 mm on), to as deep as any gate lets a stage go; above an inclusion `depth` [m] below the
/// surface, 0: without one.
[[nodiscard]] ForceTable law_table(PlainLaw law, double depth);

}  // namespace palp::patient
