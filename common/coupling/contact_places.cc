/// What the contact estimator knows of places where it was before.

#include <algorithm>
#include <utility>

#include "common/coupling/contact_estimator.h"

namespace palp::coupling {
namespace {

constexpr double kKnownDoubt = 0.3;   // [-], where the tip was before, and
constexpr double kBesideDoubt = 0.5;  // [-], beside it: of what is expected of any tissue
constexpr double kStay = 0.3;  // [s] of contact: a place that a drag only passed is forgotten first

}  // namespace

const ContactEstimator::Known* ContactEstimator::known_at(const Place& place) const noexcept {
  const Known* newest = nullptr;
  for (const Known& known : places_.known) {
    const bool newer = newest == nullptr || known.visit > newest->visit;
    if (newer && known.is_at(place)) newest = &known;
  }
  return newest;
}

const ContactEstimator::Known& ContactEstimator::last_known() const noexcept {
  return *std::ranges::max_element(places_.known, {}, &Known::visit);
}

/// Where the next place is written: over itself, else where nothing is, else over what a drag only
/// passed, else over the oldest.
ContactEstimator::Known& ContactEstimator::slot_for(const Place& place) noexcept {
  const auto age = [&place](const Known& known) {
    const int rank = known.is_at(place) ? 0 : known.visit == 0 ? 1 : known.touched < kStay ? 2 : 3;
    return std::pair{rank, known.visit};
  };
  return *std::ranges::min_element(places_.known, {}, age);
}

void ContactEstimator::remember() noexcept {
  const Known* before = known_at(places_.here);
  Known known{.place = places_.here,
              .visit = ++places_.visits,
              .touched = here_.touched + (before != nullptr ? before->touched : 0),
              .c = found_[best_],
              .surface = model_.surface,
              .stiffness = spline_.stiffness(),
              .spline_share = spline_.share(),
              .deepest = here_.deepest};
  // Found together with a breath, they are without what relaxes.
  if (swing_.believed()) {
    known.c = {};
    std::copy(model_.c.begin(), model_.c.end(), known.c.begin());
  }
  known.c.back() = 0;
  slot_for(places_.here) = known;
}

void ContactEstimator::new_place(const Place& place) noexcept {
  if (placed_ && (here_.contact || places_.visits == 0)) remember();
  places_.here = place;
  swing_.new_place(place);
  told_.held.forget();
  told_.drift.forget();
  here_.contact = false;
  here_.touched = 0;
  here_.deepest = -1;
  here_.deepest_in_air = -1;
  const Known* there = known_at(place);
  if (!placed_ && there == nullptr) return;
  const Known& expected = there != nullptr ? *there : last_known();
  expected_.c = here_.expected = expected.c;
  expected_.doubt = there != nullptr && there->touched > kStay ? kKnownDoubt : kBesideDoubt;
  place_grid(expected.surface);
  spline_.expect(expected.stiffness, expected.spline_share);
  if (there == nullptr) return;
  here_.deepest = there->deepest;
  Solution again;
  again.c = expected.c;
  publish(again);
  told_.held.tell(model_);
}

}  // namespace palp::coupling
