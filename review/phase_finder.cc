#include "review/phase_finder.h"

namespace palp::review {
namespace {

judge::PhaseKind kind_of(surgeon::StretchKind kind) {
  switch (kind) {
    case surgeon::StretchKind::Air:
      return judge::PhaseKind::FreeAir;
    case surgeon::StretchKind::Tap:
      return judge::PhaseKind::Tap;
    case surgeon::StretchKind::PressHold:
      return judge::PhaseKind::PressHold;
    case surgeon::StretchKind::LiftHold:
      return judge::PhaseKind::LiftHold;
    case surgeon::StretchKind::Drag:
      return judge::PhaseKind::Drag;
    default:
      return judge::PhaseKind::Other;
  }
}

}  // namespace

PhaseFinder::PhaseFinder(const surgeon::GestureScript& script) {
  int taps = 0;
  int presses = 0;
  Place place = script.at(Duration{0}).place;
  for (const surgeon::Stretch& stretch : script.stretches()) {
    Entry entry{stretch.began_at, stretch.began_at + stretch.duration, {}, stretch.searches};
    entry.tag.kind = kind_of(stretch.kind);
    entry.tag.site = site_at(stretch.place);
    entry.tag.place = stretch.place;
    entry.tag.duration = seconds(stretch.duration);
    // Each visit begins with a first tap: the law has seen another place meanwhile.
    if (stretch.place != place || stretch.searches) taps = presses = 0;
    place = stretch.place;
    if (entry.tag.kind == judge::PhaseKind::Tap) entry.tag.index = ++taps;
    if (entry.tag.kind == judge::PhaseKind::PressHold) entry.tag.index = ++presses;
    entries_.push_back(entry);
  }
}

PhaseFinder::Found PhaseFinder::find(Duration script_time, const Place& hand) noexcept {
  if (entries_.empty()) return {};
  if (script_time < entries_[present_].began_at) present_ = 0;
  while (present_ + 1 < entries_.size() && script_time >= entries_[present_].ends_at) ++present_;
  const Entry& entry = entries_[present_];
  Found found{entry.tag, entry.began_at, entry.ends_at - entry.began_at};
  found.tag.elapsed = seconds(script_time - entry.began_at);
  if (entry.searches) {
    found.tag.place = hand;
    found.tag.site = site_at(hand);
  }
  return found;
}

}  // namespace palp::review
