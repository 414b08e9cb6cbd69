#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "study/psychometric.h"

namespace palp::study {

/// What is believed of an observer before the first answer. ln JND and PSE: normal; lapse:
/// Beta(1, lapse_shape), most at 0. JNDs in level_unit() of the task.
struct ObserverPrior {
  double jnd{0.15};    ///< [-], > 0: median
  double jnd_sd{1.0};  ///< [-], of ln JND; > 0
  double pse_sd{0.3};  ///< [-], two-sided tasks; > 0
  /// [-], >= 1. 45: 2.2 % on average. With psignifit's 10 (9 %) one takes errors for lapses, and 60
  /// answers give a JND that is 7 % too small.
  double lapse_shape{45};
};

/// Where the posterior is held: JND and lapse for a forced choice, the PSE too if two-sided. JNDs
/// in level_unit() of the task.
struct ObserverGrid {
  double jnd_min{0.01};         ///< [-], > 0
  double jnd_max{2.0};          ///< [-]
  std::size_t jnd_count{81};    ///< >= 2
  double lapse_max{0.15};       ///< [-], < 1
  std::size_t lapse_count{13};  ///< >= 2
  double pse_reach{0.8};        ///< [-], from -reach to +reach
  std::size_t pse_count{33};    ///< >= 2
};

/// A marginal of the posterior.
struct Marginal {
  double mean{};    ///< [-]
  double sd{};      ///< [-]
  double median{};  ///< [-]
  double low{};     ///< [-], 95 % interval
  double high{};    ///< [-]
};

/// The shares of answers for every level and every cell of a grid, and the prior's weights: made
/// once, shared by all observers of a study. Immutable.
class AnswerTable {
 public:
  /// `levels`: those that trials may have; not empty, increasing.
  AnswerTable(const Task& task,
              const ObserverPrior& prior,
              const ObserverGrid& grid,
              std::vector<double> levels);

  [[nodiscard]] const Task& task() const noexcept { return task_; }
  [[nodiscard]] std::span<const double> levels() const noexcept { return levels_; }
  [[nodiscard]] std::span<const double> ln_jnd() const noexcept { return ln_jnd_; }
  [[nodiscard]] std::span<const double> pse() const noexcept { return pse_; }
  [[nodiscard]] std::span<const double> lapse() const noexcept { return lapse_; }
  [[nodiscard]] std::span<const double> prior() const noexcept { return prior_; }
  /// Of all cells in the order pse, ln JND, lapse, the last running fastest.
  [[nodiscard]] std::span<const double> shares(std::size_t level) const noexcept {
    return std::span{shares_}.subspan(level * prior_.size(), prior_.size());
  }
  /// The level nearest to `wanted`.
  [[nodiscard]] std::size_t nearest(double wanted) const noexcept;

 private:
  Task task_;
  std::vector<double> levels_;  ///< [-]
  std::vector<double> ln_jnd_;  ///< [-]
  std::vector<double> pse_;     ///< [-]
  std::vector<double> lapse_;   ///< [-]
  std::vector<double> prior_;   ///< [-]
  std::vector<double> shares_;  ///< [-]
};

/// Posterior of one observer on the grid of a table, which outlives it. The order of the answers
/// does not matter but for rounding.
class AnswerPosterior {
 public:
  explicit AnswerPosterior(const AnswerTable& table);

  /// At the level with that index. An answer that no cell allows leaves the posterior as it is.
  void told(std::size_t level, bool yes);

  [[nodiscard]] Marginal ln_jnd() const;
  [[nodiscard]] Marginal pse() const;
  [[nodiscard]] double lapse_mean() const;

  /// Entropy [nat] of PSE and JND to be expected after one more answer at that level. The lapse is
  /// summed out first: to learn it is not the purpose (Prins 2013).
  [[nodiscard]] double expected_entropy(std::size_t level) const;

  [[nodiscard]] std::span<const double> weights() const noexcept { return weights_; }
  [[nodiscard]] const AnswerTable& table() const noexcept { return *table_; }

 private:
  const AnswerTable* table_;
  std::vector<double> weights_;  ///< [-], sum 1
};

}  // namespace palp::study
