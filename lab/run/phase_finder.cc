#include "lab/run/phase_finder.h"

#include <array>

#include "patient_site/phantom.h"

namespace palp::lab {
namespace {

PhaseKind kind_of(surgeon::StretchKind kind) {
  switch (kind) {
    case surgeon::StretchKind::Air:
      return PhaseKind::FreeAir;
    case surgeon::StretchKind::Tap:
      return PhaseKind::Tap;
    case surgeon::StretchKind::PressHold:
      return PhaseKind::PressHold;
    case surgeon::StretchKind::LiftHold:
      return PhaseKind::LiftHold;
    default:
      return PhaseKind::Other;
  }
}

}  // namespace

PhaseFinder::PhaseFinder(const surgeon::GestureScript& script) {
  std::array<int, 2> taps{};
  std::array<int, 2> presses{};
  double lateral = script.at(Duration{0}).lateral;  // [m]
  for (const surgeon::Stretch& stretch : script.stretches()) {
    Entry entry{stretch.began_at, stretch.began_at + stretch.duration, {}};
    entry.tag.kind = kind_of(stretch.kind);
    entry.tag.site = stretch.lateral < patient::Phantom::kSiteBoundary ? Site::A : Site::B;
    entry.tag.duration = seconds(stretch.duration);
    const auto site = static_cast<std::size_t>(entry.tag.site);
    // Each visit begins with a first tap: the law has seen another place meanwhile.
    if (stretch.lateral != lateral) taps[site] = presses[site] = 0;
    lateral = stretch.lateral;
    if (entry.tag.kind == PhaseKind::Tap) entry.tag.index = ++taps[site];
    if (entry.tag.kind == PhaseKind::PressHold) entry.tag.index = ++presses[site];
    entries_.push_back(entry);
  }
}

PhaseTag PhaseFinder::at(Duration script_time) noexcept {
  if (entries_.empty()) return {};
  if (script_time < entries_[present_].began_at) present_ = 0;
  while (present_ + 1 < entries_.size() && script_time >= entries_[present_].ends_at) ++present_;
  PhaseTag tag = entries_[present_].tag;
  tag.elapsed = seconds(script_time - entries_[present_].began_at);
  return tag;
}

}  // namespace palp::lab
