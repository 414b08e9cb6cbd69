#include "study/person_trial.h"

namespace palp::study {
namespace {

constexpr double kContact = 0.1;  // [N], above the noise and the steps of a sensor
constexpr double kClear = 0.05;   // [N], a touch has ended below it, after kClearFor
constexpr Duration kClearFor = std::chrono::milliseconds{80};

PersonStage stage_of(TrialStage stage) noexcept {
  switch (stage) {
    case TrialStage::Travel:
      return PersonStage::Travel;
    case TrialStage::Explore:
      return PersonStage::Touch;
    case TrialStage::Answer:
      return PersonStage::Answer;
    case TrialStage::Told:
      return PersonStage::Told;
    case TrialStage::Done:
      return PersonStage::Done;
    case TrialStage::Ended:
      break;
  }
  return PersonStage::Press;
}

}  // namespace

void PersonTrial::begin_anew(PersonNotice why) noexcept {
  trial_.reset();
  notice_ = why;
  stage_ = PersonStage::Press;
  touching_ = false;
  stood_.reset();
  path_ = force_sum_ = 0;
  force_ticks_ = 0;
}

void PersonTrial::tick(TimePoint now, const SiteNews& news, std::optional<std::size_t> answer) {
  if (stage_ == PersonStage::Done) return;
  if (!offered_at_) offered_at_ = now;
  if (!trial_) {
    const bool touches = news.contact_force > kContact;
    stage_ = news.engaged && touches ? PersonStage::Lift : PersonStage::Press;
    if (!news.engaged || touches) return;
    trial_.emplace(plan_.places.size(), plan_.taps, plan_.practice, plan_.times, plan_.choices);
    ++attempts_;
  }
  step(now, news, answer);
}

void PersonTrial::step(TimePoint now, const SiteNews& news, std::optional<std::size_t> answer) {
  if (stage_ == PersonStage::Touch && plan_.hidden) follow(news);
  trial_->tick(now,
               {.force = news.force,
                .contact = touches(now, news.contact_force),
                .pedal = news.engaged,
                .answer = answer});
  if (trial_->stage() == TrialStage::Ended) return begin_anew(PersonNotice::LetGo);
  if (plan_.hidden && trial_->answer() && trial_->contact() == Duration{}) {
    return begin_anew(PersonNotice::Untouched);
  }
  const PersonStage next = stage_of(trial_->stage());
  const bool came = stage_ == PersonStage::Travel && next == PersonStage::Touch;
  if (came && distance(news.stands, plan_.places[trial_->interval()]) > kSamePlace) {
    return begin_anew(PersonNotice::HeldUp);
  }
  stage_ = next;
  if (stage_ == PersonStage::Travel) {
    place_ = StagePlace{trial_->by_decoy(now) ? plan_.decoy : plan_.places[trial_->interval()]};
  } else if (came && plan_.hidden) {
    place_->reach = plan_.hidden->reach;
  }
}

/// One touch is one, however slowly the tip comes and however much the sensor's noise is.
bool PersonTrial::touches(TimePoint now, double force) noexcept {
  if (force > (touching_ ? kClear : kContact)) {
    touching_ = true;
    touched_at_ = now;
  } else if (now - touched_at_ > kClearFor) {
    touching_ = false;
  }
  return touching_;
}

/// How the tip goes about a search.
void PersonTrial::follow(const SiteNews& news) noexcept {
  path_ += distance(news.stands, stood_.value_or(news.stands));
  stood_ = news.stands;
  if (news.contact_force <= kContact) return;
  force_sum_ += news.contact_force;
  ++force_ticks_;
}

TrialOutcome PersonTrial::outcome(TimePoint now) const {
  TrialOutcome out{.chosen = *trial_->answer(),
                   .onset = 0,
                   .duration = seconds(now - *offered_at_),
                   .response_time = seconds(trial_->response_time()),
                   .taps = trial_->taps(),
                   .force_max = trial_->force_max(),
                   .contact = seconds(trial_->contact())};
  if (!plan_.hidden) return out;
  out.error = distance(stood_.value_or(plan_.places.front()), plan_.hidden->axis);
  out.chosen = out.error <= plan_.hidden->within ? 0 : 1;
  out.path = path_;
  out.force_mean = force_ticks_ > 0 ? force_sum_ / static_cast<double>(force_ticks_) : 0;
  return out;
}

}  // namespace palp::study
