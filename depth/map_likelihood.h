#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "depth/ball_field.h"
#include "depth/place_data.h"

namespace palp::depth {

/// A ball below a plane surface, in the coordinates of the posterior.
inline constexpr std::size_t kBallCoordinates = 5;
struct MapBall {
  Place place;         ///< of its axis
  double log_depth{};  ///< [-], of m, its top
  double radius{};     ///< [m]
  double log_ratio{};  ///< [-]
};

/// What is known of a tissue before it was touched.
struct TissuePrior {
  StiffnessPrior stiffness;
  /// [-], standard deviation of the stiffness from place to place, over its mean; how much of it
  /// this tissue shows is learnt.
  double place_spread{0.05};
  /// [-], of what an inclusion adds to the logarithm of the force: how far the model is off.
  double model_error{0.02};
};

/// The likelihood of a ball, or of none, from the touches at all places. Integrated out: Young's
/// modulus, the rate factor, the shape of the plain tissue's curve, each place's surface and how
/// much each place's stiffness differs (evenly over three spreads, to place_spread). Costs about
/// 0.1 us a place. A value, immutable after construction. Thread: estimator.
class MapLikelihood {
 public:
  /// `field` outlives it.
  MapLikelihood(const BallField& field, const TissuePrior& prior, std::vector<PlaceData> places);

  [[nodiscard]] const std::vector<PlaceData>& places() const noexcept { return places_; }

  /// [-], logarithm, up to a constant that is the same for every ball and none.
  [[nodiscard]] double at(const MapBall& ball) const noexcept;
  [[nodiscard]] double plain() const noexcept { return plain_; }

  /// The logarithm and its slopes and information by the five coordinates, the tissue unknown. The
  /// slopes count the force as in the tissue first found, without a ball: a tenth off where the
  /// ball makes it another.
  struct Local {
    double value{};                                ///< [-]
    std::array<double, kBallCoordinates> slope{};  ///< [1/coordinate]
    std::array<std::array<double, kBallCoordinates>, kBallCoordinates> information{};
  };
  [[nodiscard]] Local around(const MapBall& ball) const noexcept;

  /// What a place's force is over that of the tissue found without it [-], in logarithm.
  struct Excess {
    double value{};   ///< [-]
    double stddev{};  ///< [-], by its own noise and the largest spread
  };
  [[nodiscard]] const std::vector<Excess>& excess() const noexcept { return excess_; }

  /// What the tissue is if this ball is below, and how far each place is off it.
  struct Rest {
    double scale{1};                 ///< [-], of Young's modulus
    double spread{};                 ///< [-], of the stiffness from place to place, the likeliest
    double rate_factor{};            ///< [s/m]
    std::vector<double> deviations;  ///< by place [-], in standard deviations of spread and noise
  };
  [[nodiscard]] Rest rest(const MapBall* ball) const;  ///< nullptr: no ball

 private:
  static constexpr std::size_t kTissue = 2 + kTissueShapes;  ///< scale, shapes, rate factor
  static constexpr std::size_t kSpreads = 3;
  template <std::size_t N>
  struct Normal {
    std::array<std::array<double, N>, N> matrix{};
    std::array<double, N> right{};  ///< [-]
    double square{};                ///< [-]
    double log_determinant{};       ///< [-]
  };
  template <std::size_t N>
  void gather(const PlaceData& place,
              const std::array<NodalCurve, N>& curves,
              double middle,
              std::array<Normal<N + 1>, kSpreads>& to) const noexcept;
  [[nodiscard]] static double middle_of(const NodalCurve& ratio) noexcept;
  [[nodiscard]] std::array<NodalCurve, kTissue - 1> columns(const NodalCurve& ratio) const noexcept;
  void add_prior(Normal<kTissue>& to) const noexcept;
  template <class Ratio>
  [[nodiscard]] std::array<double, kSpreads> spread_values(const Ratio& ratio) const noexcept;
  [[nodiscard]] std::array<Normal<kTissue + kBallCoordinates>, kSpreads> gather_around(
      const MapBall& ball) const noexcept;
  void find_tissue();
  void find_excess();

  const BallField* field_;
  TissuePrior prior_;
  std::vector<PlaceData> places_;
  // The tissue from which its unknowns are counted.
  double scale_{1};                             ///< [-]
  std::array<double, kTissueShapes> shapes_{};  ///< [-]
  NodalCurve curve_{};                          ///< [-], of the plain tissue
  std::array<double, kSpreads> spreads_{};      ///< [-]
  double plain_{};                              ///< [-]
  std::vector<Excess> excess_;
};

}  // namespace palp::depth
