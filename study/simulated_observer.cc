#include "study/simulated_observer.h"

#include "common/core/random.h"

namespace palp::study {

bool FormulaObserver::answer(double level, std::size_t index) const noexcept {
  return random_uniform(seed, stream, index) < answer_share(task, traits, level);
}

std::vector<Answers> run_track(Track& track, const FormulaObserver& observer) {
  const auto levels = track.posterior().table().levels();
  std::vector<Answers> answers;
  while (!track.done()) {
    const std::size_t level = track.next();
    const bool yes = observer.answer(levels[level], track.trials());
    track.told(level, yes);
    answers.push_back({levels[level], yes ? std::size_t{1} : 0, 1});
  }
  return pooled(answers);
}

}  // namespace palp::study
