#include "surgeon_site/force_shortage.h"

#include <algorithm>

namespace palp::surgeon {
namespace {

using record::NoteCode;

// Less than this is not felt; what is shorter is the model coming in.
constexpr double kLeast = 0.05;  // [N]
constexpr double kShare = 0.05;  // [-], of the tissue's force
constexpr double kStill = 0.8;   // [-], of these: below it is over
constexpr double kOn = 0.3;      // [s]
constexpr double kOff = 0.1;     // [s]
// Over a long path the tissue under a dragged hand is not the one that the tip feels.
constexpr double kApart = 2e-3;    // [m]
constexpr double kContact = 0.05;  // [N]
constexpr double kApartOn = 0.25;  // [s]

}  // namespace

void ForceShortage::Lasting::look(bool is, double on, double off, double passed) noexcept {
  if (is == said_) {
    otherwise_ = 0;
    return;
  }
  otherwise_ += passed;
  if (otherwise_ < (is ? on : off)) return;
  said_ = is;
  otherwise_ = 0;
}

void ForceShortage::look(const Look& now,
                         const PatientDevices& devices,
                         const Lapse& lapse) noexcept {
  if (now.state == SiteState::Hold) return comparison_.restart();
  if (now.state != SiteState::Engaged) {
    *this = ForceShortage{};
    return;
  }
  const double passed = seconds(lapse.passed());
  const double lacks = now.missing + now.too_stiff;
  const double noticed = std::max(kLeast, kShare * (lacks + now.tip.given));
  law_.look(lacks > (law_.said() ? kStill : 1) * noticed, kOn, kOff, passed);
  const bool touches = std::max(now.tip.measured, now.tip.given) > kContact;
  elsewhere_.look(touches && now.apart > kApart, kApartOn, kOff, passed);
  comparison_.look(now.tip, devices, passed);
  why_ = reason(now);
  by_ = law_.said() ? lacks : comparison_.says_more() ? std::max(0.0, comparison_.more()) : 0;
}

/// The law's own word helps most. Which of its two it was stays, unless the other is twice as much:
/// what changes to and fro is not read.
NoteCode ForceShortage::reason(const Look& now) const noexcept {
  if (law_.said()) {
    const bool was_stiff = why_ == NoteCode::TissueTooStiff;
    const double bias = was_stiff ? 2 : why_ == NoteCode::ForceIncomplete ? 0.5 : 1;
    return bias * now.too_stiff > now.missing ? NoteCode::TissueTooStiff
                                              : NoteCode::ForceIncomplete;
  }
  if (comparison_.says_more()) return NoteCode::TipFeelsMore;
  return elsewhere_.said() ? NoteCode::TipElsewhere : NoteCode::None;
}

}  // namespace palp::surgeon
