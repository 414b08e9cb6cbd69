#include "study/track.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/core/check.h"
#include "common/core/random.h"

namespace palp::study {
namespace {

/// Every level once, in an order that `round` of a stream draws.
std::size_t drawn_level(std::size_t levels,
                        std::size_t trial,
                        std::uint64_t seed,
                        std::uint64_t stream) {
  const std::size_t round = trial / levels;
  std::vector<std::size_t> order(levels);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t level) {
    return random_bits(seed, stream, round * levels + level);
  });
  return order[trial % levels];
}

std::size_t most_telling(const AnswerPosterior& posterior) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t level = 0; level < posterior.table().levels().size(); ++level) {
    const double entropy = posterior.expected_entropy(level);
    if (entropy < least) {
      least = entropy;
      best = level;
    }
  }
  return best;
}

}  // namespace

Track::Track(const AnswerTable& table,
             const Method& method,
             std::uint64_t seed,
             std::uint64_t stream)
    : method_{method},
      posterior_{table},
      seed_{seed},
      stream_{stream},
      ln_level_{std::log(method.staircase.start)} {
  PALP_CHECK(method.kind == MethodKind::Constant || method.kind == MethodKind::QuestPlus ||
                 !table.task().two_sided,
             "staircase and QUEST ask for levels of one sign");
}

std::size_t Track::next() const {
  const AnswerTable& table = posterior_.table();
  switch (method_.kind) {
    case MethodKind::Constant:
      return method_.constant_from +
             drawn_level(table.levels().size() - method_.constant_from, trials_, seed_, stream_);
    case MethodKind::Staircase:
      return table.nearest(std::exp(ln_level_));
    case MethodKind::Quest:
      return table.nearest(method_.quest_jnds * std::exp(posterior_.ln_jnd().mean));
    case MethodKind::QuestPlus:
      break;
  }
  return most_telling(posterior_);
}

void Track::told(std::size_t level, bool yes) {
  posterior_.told(level, yes);
  ++trials_;
  if (method_.kind == MethodKind::Staircase) move_staircase(yes);
}

void Track::move_staircase(bool yes) {
  const StaircaseRule& rule = method_.staircase;
  const double step = reversals_.size() < 3 ? rule.step_first : rule.step;
  int move = 0;
  if (!yes) {
    move = 1;
  } else if (++right_in_a_row_ == rule.right_to_go_down) {
    move = -1;
  }
  if (move == 0) return;
  right_in_a_row_ = 0;
  if (direction_ == -move) reversals_.push_back(ln_level_);
  direction_ = move;
  const auto levels = posterior_.table().levels();
  ln_level_ = std::clamp(ln_level_ + (move > 0 ? step : -step * rule.down_over_up),
                         std::log(levels.front()),
                         std::log(levels.back()));
}

bool Track::done() const {
  const StopRule& stop = method_.stop;
  if (trials_ >= stop.trials_max) return true;
  if (method_.kind == MethodKind::Staircase) {
    return reversals_.size() >= method_.staircase.reversals;
  }
  return trials_ >= stop.trials_min && posterior_.ln_jnd().sd <= stop.ln_jnd_sd;
}

std::optional<double> Track::reversal_level() const {
  const std::size_t used = method_.staircase.reversals_used;
  if (used == 0 || reversals_.size() < used) return std::nullopt;
  const double sum =
      std::accumulate(reversals_.end() - static_cast<std::ptrdiff_t>(used), reversals_.end(), 0.0);
  return std::exp(sum / static_cast<double>(used));
}

double staircase_share(const StaircaseRule& rule) {
  // Up and down balance where p^n (down) = (1 - p^n) (up).
  const double all_right = 1 / (1 + rule.down_over_up);
  return std::pow(all_right, 1.0 / rule.right_to_go_down);
}

}  // namespace palp::study
