#include "study/simulated_observer.h"

#include <cmath>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace palp::study
