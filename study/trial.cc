#include "study/trial.h"

#include <algorithm>
#include <cmath>

namespace palp::study {

Trial::Trial(std::size_t intervals,
             int taps,
             bool practice,
             const TrialTimes& times,
             std::size_t choices) noexcept
    : intervals_{intervals},
      choices_{choices > 0 ? choices : intervals},
      taps_wanted_{taps},
      practice_{practice},
      times_{times} {}

void Trial::enter(TrialStage stage, TimePoint now) noexcept {
  stage_ = stage;
  entered_at_ = now;
}

Duration Trial::length(TimePoint now) const noexcept {
  return began_at_ ? now - *began_at_ : Duration{};
}

bool Trial::by_decoy(TimePoint now) const noexcept {
  return stage_ == TrialStage::Travel && 2 * (now - entered_at_) < times_.travel;
}

void Trial::explore(TimePoint now, const TrialInput& in) noexcept {
  force_max_ = std::max(force_max_, std::abs(in.force));
  if (in.contact) contact_ += now - last_;
  if (touching_ && !in.contact) {
    ++taps_;
    ++taps_now_;
  }
  touching_ = in.contact;
  const bool enough = !times_.searches && taps_now_ >= taps_wanted_ && !in.contact;
  if (!enough && now - entered_at_ < times_.explore_max) return;
  touching_ = false;
  if (interval_ + 1 < intervals_) {
    ++interval_;
    taps_now_ = 0;
    enter(TrialStage::Travel, now);
  } else {
    enter(TrialStage::Answer, now);
    if (!times_.searches) asked_at_ = now;
  }
}

void Trial::hear(TimePoint now, const TrialInput& in) noexcept {
  if (!in.answer || *in.answer >= choices_) return;
  answer_ = in.answer;
  response_time_ = now - asked_at_;
  enter(practice_ ? TrialStage::Told : TrialStage::Done, now);
}

void Trial::tick(TimePoint now, const TrialInput& in) noexcept {
  if (!began_at_) {
    began_at_ = entered_at_ = last_ = now;
  }
  // Who answers may have let go: a button is pressed by the same hand.
  const bool moves =
      stage_ == TrialStage::Travel || (stage_ == TrialStage::Explore && !times_.searches);
  if (!in.pedal && moves) enter(TrialStage::Ended, now);
  switch (stage_) {
    case TrialStage::Travel:
      if (now - entered_at_ < times_.travel) break;
      enter(TrialStage::Explore, now);
      asked_at_ = now;
      break;
    case TrialStage::Explore:
      explore(now, in);
      if (times_.searches) hear(now, in);
      break;
    case TrialStage::Answer:
      hear(now, in);
      break;
    case TrialStage::Told:
      if (now - entered_at_ >= times_.told) enter(TrialStage::Done, now);
      break;
    case TrialStage::Done:
    case TrialStage::Ended:
      break;
  }
  last_ = now;
}

}  // namespace palp::study
