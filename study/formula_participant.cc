#include "study/formula_participant.h"

#include <cmath>

#include "common/core/random.h"
#include "study/trial.h"

namespace palp::study {
namespace {

constexpr std::uint64_t kPeople = 0x70656f706c650000;  // streams apart from those of schedules
constexpr std::uint64_t kAnswers = 0x616e737765720000;
constexpr std::uint64_t kResponse = 0;
constexpr std::uint64_t kYes = 1;
constexpr std::uint64_t kWrong = 2;

constexpr double kCriterionSpread = 0.3;                 // [-], from one person to the next
constexpr std::uint64_t kCriteria = 0x6372697465726961;  // a stream apart
// Two intervals are compared with the noise of two judgements, one with that of one.
constexpr double kPerJudgement = 0.707106781186547524;  // [-]

constexpr Duration kTick = std::chrono::milliseconds{1};
constexpr Duration kTap = std::chrono::milliseconds{600};  // of a tap, half of it in the tissue
constexpr double kForce = 0.5;                             // [N], of a tap

/// From the first to the last stage of a trial, with taps one after the other.
TrialOutcome live_through(Trial trial, double response_time, std::size_t chosen) {
  TimePoint now{};
  TimePoint asked_at{};
  TrialStage before = TrialStage::Travel;
  TimePoint stage_at{};
  while (trial.stage() != TrialStage::Done) {
    TrialInput in;
    if (trial.stage() != before) {
      before = trial.stage();
      stage_at = now;
      if (before == TrialStage::Answer) asked_at = now;
    }
    if (before == TrialStage::Explore) {
      in.contact = 2 * ((now - stage_at) % kTap) >= kTap;
      in.force = in.contact ? kForce : 0;
    }
    if (before == TrialStage::Answer && now - asked_at >= from_seconds(response_time)) {
      in.answer = chosen;
    }
    trial.tick(now, in);
    now += kTick;
  }
  return {.chosen = chosen,
          .onset = 0,
          .duration = seconds(trial.length(now)),
          .response_time = seconds(trial.response_time()),
          .taps = trial.taps(),
          .force_max = trial.force_max(),
          .contact = seconds(trial.contact())};
}

}  // namespace

double drawn_ln_jnd(const PeopleTraits& people,
                    std::uint64_t seed,
                    std::size_t participant) noexcept {
  return std::log(std::log1p(people.weber)) +
         people.spread * random_normal(seed, kPeople, participant);
}

std::uint64_t trial_stream(const TrialPlace& place, std::size_t trial) noexcept {
  return kAnswers + (place.participant * kConditionsMax + place.condition) * 4096 + trial;
}

double drawn_response_time(std::uint64_t seed,
                           const TrialPlace& place,
                           std::size_t trial) noexcept {
  return 0.8 * std::exp(0.4 * random_normal(seed, trial_stream(place, trial), kResponse));
}

double drawn_criterion(std::uint64_t seed, std::size_t participant) noexcept {
  return kCriterion + kCriterionSpread * random_normal(seed, kCriteria, participant);
}

ObserverTraits drawn_traits(const Study& study,
                            const PeopleTraits& people,
                            std::size_t participant) noexcept {
  const double jnd = std::exp(drawn_ln_jnd(people, study.seed, participant));
  const double criterion = drawn_criterion(study.seed, participant);
  return {.jnd = study.task.yes_no ? jnd * kPerJudgement : jnd,
          .pse = study.task.yes_no ? criterion * jnd * kPerJudgement / kQuartile : 0,
          .lapse = people.lapse};
}

Observer formula_participants(const Study& study, const PeopleTraits& people) {
  return [study, people](const TrialPlace& place, const TrialAsk& ask) {
    const ObserverTraits traits = drawn_traits(study, people, place.participant);
    const bool yes = random_uniform(study.seed, trial_stream(place, ask.number), kYes) <
                     answer_share(study.task, traits, ask.level);
    const std::size_t stronger = study.task.two_sided ? 1 : ask.stronger;
    // Who is wrong chooses each of the others alike.
    const auto intervals = static_cast<std::size_t>(study.task.intervals);
    const std::size_t further =
        yes ? 0
            : 1 + random_bits(study.seed, trial_stream(place, ask.number), kWrong) %
                      (intervals - 1);
    return live_through({study.task.yes_no ? 1 : intervals,
                         study.conditions[place.condition].taps,
                         ask.kind == TrialKind::Practice,
                         TrialTimes{},
                         intervals},
                        drawn_response_time(study.seed, place, ask.number),
                        (stronger + further) % intervals);
  };
}

}  // namespace palp::study
