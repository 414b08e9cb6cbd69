#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "depth/map_posterior.h"

namespace palp::depth {

/// Why numbers are not to be trusted.
enum class MapDoubt : std::uint8_t {
  Curve,       ///< the force at a place grows as no tissue of the model does
  NotOneBall,  ///< a place is stiffer or softer than one ball and the tissue's spread explain
  TwoSides,    ///< the ball may lie on either side of the touches
  Outside,     ///< the ball may well lie beyond the touched places
};
inline constexpr std::size_t kMapDoubts = 4;

/// What is wrong and what helps, one sentence each.
[[nodiscard]] std::string_view reason_of(MapDoubt doubt) noexcept;
[[nodiscard]] std::string_view remedy_of(MapDoubt doubt) noexcept;

/// What may be said of the touches as a whole.
struct MapVerdict {
  bool found{};                  ///< a ball is there
  std::vector<MapDoubt> doubts;  ///< none: its numbers may be trusted
  double worst_curve{};          ///< [-], standard deviations of the sum of a place's squares
  double worst_deviation{};      ///< [-], standard deviations of a place's stiffness
};

struct MapVerdictConfig {
  double evidence_min{2};   ///< [-], log of the odds from which there is a ball
  double gain_min{9};       ///< [-], and what the best one must gain: 3 sigma
  double curve_max{30};     ///< [-], see worst_curve: steps make them uneven
  double deviation_max{4};  ///< [-], see worst_deviation
  double side_min{0.1};     ///< [-], share of a second mode
  double outside_max{0.2};  ///< [-], share beyond the touched places
};

[[nodiscard]] MapVerdict map_verdict(const MapLikelihood& likelihood,
                                     const MapPosterior& posterior,
                                     const MapVerdictConfig& config = {});

/// One sentence for a person, which says what was assumed.
[[nodiscard]] std::string map_sentence(const MapPosterior& posterior, const MapVerdict& verdict);

}  // namespace palp::depth
