#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

/// What may be said of the touches at several places, in words. Thread: any.
namespace palp {

/// Why numbers are not to be trusted.
enum class MapDoubt : std::uint8_t {
  Curve,       ///< the force at a place grows as no tissue of the model does
  NotOneBall,  ///< a place is stiffer or softer than one ball and the tissue's spread explain
  TwoSides,    ///< the ball may lie on either side of the touches
  Outside,     ///< the ball may well lie beyond the touched places
};
inline constexpr std::size_t kMapDoubts = 4;

/// Several doubts, a bit for each.
using MapDoubts = std::uint32_t;
[[nodiscard]] constexpr MapDoubts doubts_of(MapDoubt one) noexcept {
  return MapDoubts{1} << static_cast<unsigned>(one);
}

/// Whether more touches are worth their while.
enum class MapStop : std::uint8_t {
  GoOn,
  Known,       ///< place and depth are known as well as anybody asked for
  NoMoreNews,  ///< no touch is expected to tell much
};

/// What is wrong, and what helps: one clause each.
[[nodiscard]] constexpr std::string_view reason_of(MapDoubt doubt) noexcept {
  switch (doubt) {
    case MapDoubt::Curve:
      return "the force at a place grows as in no tissue that was assumed";
    case MapDoubt::NotOneBall:
      return "one ball does not explain the stiffness at every place";
    case MapDoubt::TwoSides:
      return "the inclusion may lie at either of two places";
    case MapDoubt::Outside:
      return "the inclusion may lie beyond the touched places";
  }
  return "?";
}
[[nodiscard]] constexpr std::string_view remedy_of(MapDoubt doubt) noexcept {
  switch (doubt) {
    case MapDoubt::Curve:
      return "tap slower and check the sensor's pole";
    case MapDoubt::NotOneBall:
      return "touch between the places that differ";
    case MapDoubt::TwoSides:
      return "touch beside the line of the touches";
    case MapDoubt::Outside:
      return "touch farther out on the stiff side";
  }
  return "?";
}
[[nodiscard]] constexpr std::string_view to_string(MapStop stop) noexcept {
  switch (stop) {
    case MapStop::GoOn:
      return "";
    case MapStop::Known:
      return "place and depth are known";
    case MapStop::NoMoreNews:
      return "no further tap is expected to tell much";
  }
  return "?";
}

}  // namespace palp
