#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "depth/ball_field.h"
#include "depth/place_data.h"
#include "depth/stiffness_field.h"

namespace palp::depth {

/// A ball below a plane surface, in the coordinates of the posterior.
inline constexpr std::size_t kBallCoordinates = 5;
struct MapBall {
  Place place;         ///< of its axis
  double log_depth{};  ///< [-], of m, its top
  double radius{};     ///< [m]
  double log_ratio{};  ///< [-]
};

/// [-], standard deviation of Young's modulus over what was said of it, however sure that was:
/// touches at several places tell it, and tissue twice as stiff is no ball below all of them.
inline constexpr double kModulusSpread = 1;

/// What is known of a tissue before it was touched.
struct TissuePrior {
  StiffnessPrior stiffness;  ///< its scale_stddev gives way to kModulusSpread
  /// [-], standard deviation of the stiffness from place to place, over its mean; how much of it
  /// this tissue shows is learnt.
  double place_spread{0.05};
  /// [-], of what an inclusion adds to the logarithm of the force: how far the model is off.
  double model_error{0.02};
};

/// The likelihood of a ball, or of none, from the touches at all places. Integrated out: Young's
/// modulus, the rate factor, the shape of the plain tissue's curve, each place's surface and how
/// the stiffness differs from place to place (over the guesses of StiffnessField). Costs about
/// 0.2 us a place, and more than in proportion with many. A value, immutable after construction.
/// Thread: estimator.
class MapLikelihood {
 public:
  /// `field` outlives it.
  MapLikelihood(const BallField& field, const TissuePrior& prior, std::vector<PlaceData> places);

  [[nodiscard]] const std::vector<PlaceData>& places() const noexcept { return places_; }

  /// [-], logarithm, up to a constant that is the same for every ball and none.
  [[nodiscard]] double at(const MapBall& ball) const;
  [[nodiscard]] double plain() const noexcept { return plain_; }

  /// How likely each guess of the tissue's own stiffness is if this ball is below. [-], together 1
  [[nodiscard]] StiffnessField::ByGuess guesses(const MapBall& ball) const;
  [[nodiscard]] const StiffnessField& differs() const noexcept { return differs_; }

  /// The logarithm and its slopes and information by the five coordinates, the tissue unknown. The
  /// slopes count the force as in the tissue first found, without a ball: a tenth off where the
  /// ball makes it another.
  struct Local {
    double value{};                                ///< [-]
    std::array<double, kBallCoordinates> slope{};  ///< [1/coordinate]
    std::array<std::array<double, kBallCoordinates>, kBallCoordinates> information{};
  };
  [[nodiscard]] Local around(const MapBall& ball) const;

  /// What a place's force is over that of the tissue found without it [-], in logarithm.
  struct Excess {
    double value{};   ///< [-]
    double stddev{};  ///< [-], by its own noise and the spread given
  };
  [[nodiscard]] const std::vector<Excess>& excess() const noexcept { return excess_; }

  /// What the tissue is if this ball is below, and how far each place is off it.
  struct Rest {
    double scale{1};                 ///< [-], of Young's modulus
    std::size_t guess{};             ///< of the stiffness from place to place, the likeliest
    double spread{};                 ///< [-], its standard deviation
    double rate_factor{};            ///< [s/m]
    std::vector<double> own;         ///< by place [-], variance of its touches and of the model
    std::vector<double> shown;       ///< by place [-], of its stiffness, beyond tissue and ball
    std::vector<double> deviations;  ///< by place [-], that in standard deviations of all
  };
  [[nodiscard]] Rest rest(const MapBall* ball) const;  ///< nullptr: no ball
  /// Of the tissue's own stiffness at other places, by what the touched ones show.
  [[nodiscard]] std::vector<FieldTold> told(const Rest& rest,
                                            const std::vector<Place>& places) const {
    return differs_.told(rest.guess, rest.own, rest.shown, places);
  }

 private:
  using ByGuess = StiffnessField::ByGuess;
  static constexpr std::size_t kTissue = 2 + kTissueShapes;  ///< scale, shapes, rate factor
  template <std::size_t N>
  struct Normal {
    std::array<std::array<double, N>, N> matrix{};
    std::array<double, N> right{};  ///< [-]
    double square{};                ///< [-]
    double log_determinant{};       ///< [-]
  };
  /// Of all places: what says nothing of their stiffness, and what each shows of it.
  template <std::size_t N>
  struct Gathered {
    Normal<N> equations;
    std::vector<double> own;   ///< [-], variance of what a place shows, without the field's
    std::vector<double> rows;  ///< by place [-]: what the unknowns make of it (N), what it shows
  };
  template <std::size_t N>
  void gather(const PlaceData& place,
              const std::array<NodalCurve, N>& curves,
              double middle,
              Gathered<N + 1>& to) const;
  template <std::size_t N>
  [[nodiscard]] static Normal<N> under(std::size_t guess,
                                       const Gathered<N>& gathered,
                                       const StiffnessField::Whitened& whitened);
  [[nodiscard]] static double middle_of(const NodalCurve& ratio) noexcept;
  [[nodiscard]] std::array<NodalCurve, kTissue - 1> columns(const NodalCurve& ratio) const noexcept;
  void add_prior(Normal<kTissue>& to) const noexcept;
  template <std::size_t N>
  [[nodiscard]] static StiffnessField::Whitened whiten(const StiffnessField& field,
                                                       const Gathered<N>& gathered) {
    return field.whiten(gathered.own, N + 1, gathered.rows);
  }
  template <class Ratio>
  [[nodiscard]] Gathered<kTissue> gather_all(const Ratio& ratio) const;
  [[nodiscard]] ByGuess values_at(const MapBall& ball) const;
  [[nodiscard]] ByGuess values_of(const Gathered<kTissue>& gathered,
                                  const StiffnessField::Whitened& whitened) const;
  [[nodiscard]] double mean_of(const ByGuess& values) const noexcept;
  [[nodiscard]] Gathered<kTissue + kBallCoordinates> gather_around(const MapBall& ball) const;
  void find_tissue();
  void find_excess();

  const BallField* field_;
  TissuePrior prior_;
  std::vector<PlaceData> places_;
  // The tissue from which its unknowns are counted.
  double scale_{1};                             ///< [-]
  std::array<double, kTissueShapes> shapes_{};  ///< [-]
  NodalCurve curve_{};                          ///< [-], of the plain tissue
  StiffnessField differs_;                      ///< of the places
  double plain_{};                              ///< [-]
  std::vector<Excess> excess_;
};

}  // namespace palp::depth
