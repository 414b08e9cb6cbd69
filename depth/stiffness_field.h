#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "common/core/place.h"

namespace palp::depth {

/// How the logarithm of a tissue's stiffness may differ from place to place: a Gaussian random
/// field of mean 0.
struct FieldGuess {
  double spread{};  ///< [-], standard deviation
  /// [m], correlation exp(-distance^2 / 2 length^2), as of what is smooth; 0: places are
  /// independent.
  double length{};
  double share{};  ///< [-], of the prior; together 1

  [[nodiscard]] double correlation(const Place& one, const Place& other) const noexcept;
};

/// What is known of a field at one place.
struct FieldTold {
  double mean{};      ///< [-]
  double variance{};  ///< [-]
};

/// Places of a tissue under several guesses of its field. Immutable; the guesses are reckoned side
/// by side, about 2/3 n^3 multiplications. Thread: any.
class StiffnessField {
 public:
  static constexpr std::size_t kGuesses = 8;
  static constexpr std::size_t kIndependent = 2;  ///< the guess of the whole spread and length 0
  using ByGuess = std::array<double, kGuesses>;

  StiffnessField() = default;
  /// `spread` [-] as TissuePrior has it: most of the prior is that, evenly over lengths from 0 to
  /// 20 mm. Tissue that varies less, or twice as much, is left possible.
  StiffnessField(std::vector<Place> places, double spread);

  [[nodiscard]] const FieldGuess& guess(std::size_t index) const noexcept {
    return guesses_[index];
  }

  /// What places show, made independent and of variance 1.
  struct Whitened {
    std::size_t step{};                              ///< numbers of a guess: places times width
    std::vector<double> rows;                        ///< [-], by guess, place and number
    std::array<double, kGuesses> log_determinant{};  ///< [-], of the covariance

    [[nodiscard]] std::span<const double> of(std::size_t guess) const noexcept {
      return std::span{rows}.subspan(guess * step, step);
    }
  };
  /// `own` [-]: by place, the variance that is not the field's. `rows`: `width` numbers by place.
  [[nodiscard]] Whitened whiten(const std::vector<double>& own,
                                std::size_t width,
                                const std::vector<double>& rows) const;

  /// The field at other places, where each place shows `shown` [-] and that is known but for
  /// `own`. Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), eqs. 2.25 and
  /// 2.26.
  [[nodiscard]] std::vector<FieldTold> told(std::size_t index,
                                            const std::vector<double>& own,
                                            const std::vector<double>& shown,
                                            const std::vector<Place>& others) const;

 private:
  std::vector<Place> places_;
  std::array<FieldGuess, kGuesses> guesses_{};
  std::vector<double> covariances_;  ///< [-], row by row; the guesses of an element side by side
};

}  // namespace palp::depth
