#include "study/recovery.h"

#include <algorithm>
#include <cmath>

#include "common/core/random.h"
#include "study/compare.h"
#include "study/signal_detection.h"
#include "study/simulated_observer.h"

namespace palp::study {
namespace {

// Streams of one seed.
enum : std::uint64_t { kJnd, kLapse, kSignals, kBlanks, kTracks = 16 };

AnswerTable table_of(const RecoverySet& set) {
  return {set.task, set.prior, {}, even_levels(set.level_min, set.level_max, set.levels)};
}

Track asked(const AnswerTable& table,
            const RecoverySet& set,
            const ObserverTraits& traits,
            std::uint64_t stream) {
  Track track{table, set.method, set.seed, kTracks + 2 * stream};
  (void)run_track(
      track,
      {.task = set.task, .traits = traits, .seed = set.seed, .stream = kTracks + 2 * stream + 1});
  return track;
}

double drawn_lapse(const RecoverySet& set, std::uint64_t observer) noexcept {
  return std::lerp(set.lapse_min, set.lapse_max, random_uniform(set.seed, kLapse, observer));
}

}  // namespace

std::vector<RecoveryCase> recover(const RecoverySet& set,
                                  std::size_t observers,
                                  const ForEachIndex& for_each_index) {
  const AnswerTable table = table_of(set);
  std::vector<RecoveryCase> cases(observers);
  for_each_index(observers, [&](std::size_t i) {
    const double share = random_uniform(set.seed, kJnd, i);
    const ObserverTraits traits{.jnd = set.jnd_min * std::pow(set.jnd_max / set.jnd_min, share),
                                .pse = 0,
                                .lapse = drawn_lapse(set, i)};
    const Track track = asked(table, set, traits, i);
    cases[i] = {traits, track.trials(), track.posterior().ln_jnd()};
  });
  return cases;
}

RecoverySummary summary_of(const RecoverySet& set, std::span<const RecoveryCase> cases) {
  RecoverySummary out;
  const auto n = static_cast<double>(cases.size());
  double squares = 0;
  for (const RecoveryCase& one : cases) {
    const double truth = std::log(one.truth.jnd);
    const double bound = jnd_bound(set.task, one.truth, one.trials);
    out.trials += static_cast<double>(one.trials) / n;
    out.bias += (one.ln_jnd.mean - truth) / n;
    out.bound += bound * bound / n;
    out.held += (one.ln_jnd.low <= truth && truth <= one.ln_jnd.high ? 1 : 0) / n;
  }
  for (const RecoveryCase& one : cases) {
    const double error = one.ln_jnd.mean - std::log(one.truth.jnd) - out.bias;
    squares += error * error;
  }
  out.sd = std::sqrt(squares / n);
  out.bound = std::sqrt(out.bound);
  return out;
}

GroupSummary repeat_group(const GroupSet& set,
                          std::size_t experiments,
                          const ForEachIndex& for_each_index) {
  const AnswerTable table = table_of(set.observers);
  const double middle = std::sqrt(set.observers.jnd_min * set.observers.jnd_max);
  std::vector<PairedTest> tests(experiments);
  for_each_index(experiments, [&](std::size_t experiment) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < set.participants; ++i) {
      const std::uint64_t person = experiment * set.participants + i;
      ObserverTraits traits{
          .jnd = middle * std::exp(set.spread * random_normal(set.observers.seed, kJnd, person)),
          .pse = 0,
          .lapse = drawn_lapse(set.observers, person)};
      const Track first = asked(table, set.observers, traits, 2 * person);
      traits.jnd *= std::exp(set.condition_ln);
      const Track second = asked(table, set.observers, traits, 2 * person + 1);
      differences.push_back(second.posterior().ln_jnd().mean - first.posterior().ln_jnd().mean);
    }
    tests[experiment] = paired_test(differences, set.margin);
  });
  GroupSummary out;
  for (const PairedTest& one : tests) {
    const double share = 1 / static_cast<double>(experiments);
    out.found += one.p < 0.05 ? share : 0;
    out.equal += one.equivalent < 0.05 ? share : 0;
    out.held += one.low <= set.condition_ln && set.condition_ln <= one.high ? share : 0;
  }
  return out;
}

YesNoSummary recover_yes_no(double d_prime,
                            double criterion,
                            std::size_t trials_of_each_kind,
                            std::size_t observers,
                            std::uint64_t seed) {
  // A signal is seen at d'/2, a blank at -d'/2; "yes" where what is seen is above the criterion.
  const auto yes = [&](std::uint64_t stream, std::size_t first, double middle) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < trials_of_each_kind; ++i) {
      if (middle + random_normal(seed, stream, first + i) > criterion) ++count;
    }
    return count;
  };
  YesNoSummary out;
  const auto n = static_cast<double>(observers);
  constexpr double kReach = 1.96;
  for (std::size_t i = 0; i < observers; ++i) {
    const std::size_t first = i * trials_of_each_kind;
    const Sensitivity found = sensitivity({.hits = yes(kSignals, first, d_prime / 2),
                                           .signals = trials_of_each_kind,
                                           .false_alarms = yes(kBlanks, first, -d_prime / 2),
                                           .blanks = trials_of_each_kind});
    out.d_prime_bias += (found.d_prime - d_prime) / n;
    out.criterion_bias += (found.criterion - criterion) / n;
    out.d_prime_held +=
        (std::abs(found.d_prime - d_prime) <= kReach * found.d_prime_sd ? 1 : 0) / n;
    out.criterion_held +=
        (std::abs(found.criterion - criterion) <= kReach * found.criterion_sd ? 1 : 0) / n;
  }
  return out;
}

}  // namespace palp::study
