/// What the contact estimator knows of places where it was before.

#include <algorithm>

#include "common/coupling/contact_estimator.h"

namespace palp::coupling {

/// The newest of a place counts.
const ContactEstimator::Known* ContactEstimator::known_at(const Place& place) const noexcept {
  const std::size_t count = std::min(places_.count, kPlaces);
  for (std::size_t back = 1; back <= count; ++back) {
    const Known& known = places_.known[(places_.count - back) % kPlaces];
    if (distance(known.place, place) <= kSamePlace) return &known;
  }
  return nullptr;
}

void ContactEstimator::remember() noexcept {
  Known known{.place = places_.here,
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
  places_.known[places_.count++ % kPlaces] = known;
}

void ContactEstimator::new_place(const Place& place) noexcept {
  if (placed_ && (here_.contact || places_.count == 0)) remember();
  places_.here = place;
  swing_.new_place();
  here_.contact = false;
  here_.deepest = -1;
  here_.deepest_in_air = -1;
  if (!placed_) return;
  const Known* there = known_at(place);
  const Known& expected = there != nullptr ? *there : places_.known[(places_.count - 1) % kPlaces];
  expected_ = here_.expected = expected.c;
  place_grid(expected.surface);
  spline_.expect(expected.stiffness, expected.spline_share);
  if (there == nullptr) return;
  here_.deepest = there->deepest;
  Solution again;
  again.c = expected.c;
  publish(again);
}

}  // namespace palp::coupling
