#include "fem/curve.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "common/core/conventions.h"
#include "fem/figure_text.h"
#include "fem/finite_contact.h"
#include "fem/linear_contact.h"

namespace palp::fem {
namespace {

// Of the difference to the coarser mesh: sizes differ by 1.7 (fine: 2), and the error falls with
// about the square of the size.
constexpr double kErrorOfCoarse = 0.6;
constexpr double kErrorOfNormal = 0.4;

Result<void> check_indentation(const CurveRequest& request, double indentation) {
  const Specimen& specimen = request.specimen;
  const auto refuse = [&](const std::string& limit, const std::string& why) {
    return fail("the indentation is " + length_text(indentation) + ", expected " + limit + ": " +
                why);
  };
  if (!(indentation >= 0)) return refuse("0 or more", "the tip presses into the block");
  const double tip = specimen.indenter.radius * (request.model == Model::Linear ? 1.5 : 1.2);
  if (indentation > tip)
    return refuse("at most " + length_text(tip), "beyond it the tip is no sphere");
  const double block = 0.8 * specimen.block.height;
  if (indentation > block) return refuse("at most " + length_text(block), "the base is near");
  const Inclusion& inclusion = specimen.inclusion;
  if (inclusion.shape != InclusionShape::None && inclusion.ratio > 1 &&
      !(indentation < inclusion.depth)) {
    return refuse("below " + length_text(inclusion.depth),
                  "the tip would reach the stiff inclusion");
  }
  return {};
}

Result<Curve> solve_once(const CurveRequest& request, Accuracy accuracy) {
  Curve curve;
  curve.mesh = make_mesh(request.specimen, accuracy);
  curve.rows.resize(request.indentations.size());
  std::vector<std::size_t> order(request.indentations.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return request.indentations[a] < request.indentations[b];
  });
  const auto press_all = [&](auto& contact) -> Result<void> {
    for (const std::size_t i : order) {
      auto row = contact.press(request.indentations[i]);
      if (!row) return tl::unexpected<Error>(row.error());
      curve.rows[i] = *row;
    }
    curve.field = contact.field();
    curve.equations = contact.equations();
    return {};
  };
  Result<void> done;
  if (request.model == Model::Linear) {
    const double most = request.indentations[order.back()];
    LinearContact contact{curve.mesh, request.specimen, most};
    done = press_all(contact);
  } else {
    FiniteContact contact{curve.mesh, request.specimen};
    done = press_all(contact);
  }
  if (!done) return tl::unexpected<Error>(done.error());
  return curve;
}

}  // namespace

Result<Curve> solve_curve(const CurveRequest& request) {
  if (request.indentations.empty()) return fail("no indentation is given, expected at least one");
  if (auto ok = check(request.specimen); !ok) return tl::unexpected<Error>(ok.error());
  if (request.model == Model::NeoHookean &&
      request.specimen.indenter.shape != IndenterShape::Sphere) {
    return fail("the model neo knows the sphere alone, not a punch or a cone");
  }
  for (const double indentation : request.indentations) {
    if (auto ok = check_indentation(request, indentation); !ok) {
      return tl::unexpected<Error>(ok.error());
    }
  }
  auto curve = solve_once(request, request.accuracy);
  if (!curve || !request.with_error) return curve;
  const bool fine = request.accuracy == Accuracy::Fine;
  const bool normal = request.accuracy == Accuracy::Normal;
  const double share = fine ? kErrorOfNormal : normal ? kErrorOfCoarse : 1;
  const auto other = solve_once(request, normal ? Accuracy::Coarse : Accuracy::Normal);
  if (!other) return tl::unexpected<Error>(other.error());
  for (std::size_t i = 0; i < curve->rows.size(); ++i) {
    curve->rows[i].error = share * std::abs(curve->rows[i].force - other->rows[i].force);
  }
  return curve;
}

}  // namespace palp::fem
