#include "fem/verification.h"

#include <cmath>
#include <iterator>

namespace palp::fem {
namespace {

constexpr double kOrderMissed = 0.15;  // of an observed order against theory

}  // namespace

bool Check::passed() const noexcept { return std::abs(found - wanted) <= tolerance; }

Check close(const std::string& law,
            const std::string& quantity,
            double found,
            double wanted,
            double share) {
  return {law, quantity, found, wanted, share * std::abs(wanted)};
}

Check order(const std::string& law,
            const std::string& quantity,
            double coarse_error,
            double fine_error,
            double factor,
            double wanted) {
  return {law,
          "order of " + quantity,
          std::log(coarse_error / fine_error) / std::log(factor),
          wanted,
          kOrderMissed};
}

Checks verification(Extent extent) {
  Checks all = elastic_checks(extent);
  for (Checks more : {finite_checks(extent), contact_checks(extent)}) {
    all.insert(
        all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return all;
}

}  // namespace palp::fem
