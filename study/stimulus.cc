#include "study/stimulus.h"

#include "study/orders.h"

namespace palp::study {

std::vector<Stimulus> stimuli_of(const TrialAsk& ask, const Task& task) {
  std::vector<Stimulus> out(felt_intervals(task));
  if (out.size() == 1) {
    out.front().level = ask.level;
    return out;
  }
  if (task.ranks) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].level = ask.level * (static_cast<double>(rank_in(ask.stronger, i)) - 1);
    }
    return out;
  }
  Stimulus& other = out[task.two_sided ? 1 : ask.stronger];
  (task.delays ? other.delay : other.level) = ask.level;
  return out;
}

std::vector<double> tissue_levels(const Study& study) {
  std::vector<double> out{0};
  if (study.task.delays) return out;
  for (const double level : study.levels) {
    if (level != 0) out.push_back(level);
    if (study.task.ranks) out.push_back(-level);
  }
  return out;
}

}  // namespace palp::study
