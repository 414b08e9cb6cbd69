#include "study/simulated_observer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

TEST(FormulaObserverTest, AnswersAsOftenAsTheFunctionSays) {
  const FormulaObserver person{
      .task = {}, .traits = {.jnd = 0.2, .lapse = 0.05}, .seed = 1, .stream = 7};
  for (const double level : {0.0, 0.1, 0.3, 1.0}) {
    double yes = 0;
    for (std::size_t i = 0; i < 20000; ++i) yes += person.answer(level, i) ? 1 : 0;
    const double share = answer_share(person.task, person.traits, level);
    EXPECT_NEAR(yes / 20000, share, 4 * std::sqrt(share * (1 - share) / 20000)) << level;
  }
}

// A known truth comes back: 200 observers, JND 0.08 to 0.30, lapses to 5 %, 60 answers each. Four
// standard errors; the interval's count likewise.
TEST(FormulaObserverTest, QuestPlusRecoversTheJndOfKnownObservers) {
  constexpr std::size_t kObservers = 200;
  const Task task;
  const AnswerTable table{task, {}, {}, even_levels(0.02, 1.2, 25)};
  double sum = 0;
  double squares = 0;
  int held = 0;
  for (std::uint64_t i = 0; i < kObservers; ++i) {
    const ObserverTraits traits{.jnd = 0.08 * std::pow(0.30 / 0.08, random_uniform(2, 1, i)),
                                .pse = 0,
                                .lapse = 0.05 * random_uniform(2, 2, i)};
    Track track{table, {}, 1, i};
    (void)run_track(track, {.task = task, .traits = traits, .seed = 3, .stream = i});
    const Marginal found = track.posterior().ln_jnd();
    const double error = found.mean - std::log(traits.jnd);
    sum += error;
    squares += error * error;
    held += found.low <= std::log(traits.jnd) && std::log(traits.jnd) <= found.high ? 1 : 0;
  }
  const double bias = sum / kObservers;
  const double sd = std::sqrt(squares / kObservers - bias * bias);
  EXPECT_NEAR(bias, 0, 4 * sd / std::sqrt(double{kObservers}));
  const double bound = jnd_bound(task, {.jnd = 0.15, .lapse = 0.025}, 60);
  EXPECT_LT(sd, 1.25 * bound);
  EXPECT_GT(sd, 0.85 * bound);
  EXPECT_NEAR(held / double{kObservers}, 0.95, 4 * std::sqrt(0.95 * 0.05 / kObservers));
}

}  // namespace
}  // namespace palp::study
