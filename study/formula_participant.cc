#include "study/formula_participant.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/random.h"
#include "study/orders.h"
#include "study/raster.h"
#include "study/trial.h"

namespace palp::study {
namespace {

constexpr std::uint64_t kPeople = 0x70656f706c650000;  // streams apart from those of schedules
constexpr std::uint64_t kAnswers = 0x616e737765720000;
constexpr std::uint64_t kResponse = 0;
constexpr std::uint64_t kYes = 1;
constexpr std::uint64_t kWrong = 2;
constexpr std::uint64_t kSeems = 8;
constexpr std::uint64_t kWhere = 16;

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

/// One of the answers; who is wrong gives each of the others alike.
std::size_t picked(const Study& study,
                   const ObserverTraits& traits,
                   const TrialAsk& ask,
                   std::uint64_t stream) noexcept {
  const std::size_t all = choices(study.task);
  const std::size_t stronger = study.task.two_sided ? 1 : ask.stronger;
  if (random_uniform(study.seed, stream, kYes) < answer_share(study.task, traits, ask.level)) {
    return stronger;
  }
  return (stronger + 1 + random_bits(study.seed, stream, kWrong) % (all - 1)) % all;
}

/// The order in which three intervals seem to stand: neighbours are mistaken before the outer ones.
std::size_t ordered(const Study& study,
                    const ObserverTraits& traits,
                    const TrialAsk& ask,
                    std::uint64_t stream) noexcept {
  if (random_uniform(study.seed, stream, kYes) < traits.lapse) {
    return random_bits(study.seed, stream, kWrong) % kOrders.size();
  }
  const double step = d_prime_at_jnd(study.task) * ask.level / traits.jnd;
  std::array<double, kRanked> seems{};
  for (std::size_t i = 0; i < seems.size(); ++i) {
    seems[i] = step * static_cast<double>(rank_in(ask.stronger, i)) +
               random_normal(study.seed, stream, kSeems + i);
  }
  return order_of(seems);
}

/// A search in rows, one touch at each place; what is said lies anywhere where it is right, or
/// where it is wrong.
TrialOutcome searched(const Study& study,
                      const TrialPlace& place,
                      const TrialAsk& ask,
                      bool found) {
  const SearchArea& area = study.search;
  const std::uint64_t stream = trial_stream(place, ask.number);
  TrialOutcome out{.chosen = found ? std::size_t{0} : 1};
  for (std::uint64_t i = 0;; i += 2) {
    out.error = distance(drawn_place(area, study.seed, stream, kWhere + i), ask.hidden);
    if ((out.error <= area.within) == found) break;
  }
  const std::vector<Place> places = raster_in_time(area, seconds(kTap));
  const std::size_t touches = places.size();
  out.taps = static_cast<int>(touches);
  out.path = length_of(places);
  out.force_max = kForce;
  out.force_mean = kForce;
  out.contact = static_cast<double>(touches) * seconds(kTap) / 2;
  out.response_time = std::min(area.limit,
                               static_cast<double>(touches) * seconds(kTap) +
                                   drawn_response_time(study.seed, place, ask.number));
  out.duration = out.response_time + seconds(TrialTimes{}.travel);
  return out;
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
  const double jnd =
      level_unit(study.task) * std::exp(drawn_ln_jnd(people, study.seed, participant));
  const double criterion = drawn_criterion(study.seed, participant);
  return {.jnd = study.task.yes_no ? jnd * kPerJudgement : jnd,
          .pse = study.task.yes_no ? criterion * jnd * kPerJudgement / kQuartile : 0,
          .lapse = people.lapse};
}

Observer formula_participants(const Study& study, const PeopleTraits& people) {
  return [study, people](const TrialPlace& place, const TrialAsk& ask) {
    const ObserverTraits traits = drawn_traits(study, people, place.participant);
    const std::uint64_t stream = trial_stream(place, ask.number);
    if (study.task.places > 0) {
      return searched(study, place, ask, picked(study, traits, ask, stream) == 0);
    }
    return live_through({felt_intervals(study.task),
                         study.conditions[place.condition].taps,
                         ask.kind == TrialKind::Practice,
                         TrialTimes{},
                         choices(study.task)},
                        drawn_response_time(study.seed, place, ask.number),
                        study.task.ranks ? ordered(study, traits, ask, stream)
                                         : picked(study, traits, ask, stream));
  };
}

}  // namespace palp::study
