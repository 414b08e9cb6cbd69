#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lab/plan/plan.h"

/// What the cases of all sets are made of.
namespace palp::lab {

/// One path both ways, and who palpates what.
struct SetDraw {
  double round_trip{};       ///< [s]
  double jitter{};           ///< [-], standard deviation over mean
  double loss{};             ///< [-]
  double burst_rate{};       ///< [1/s]
  double burst_length{0.2};  ///< [s]
  double duplicate{};        ///< [-]
  std::string_view grip{"mid"};
  double servo{20};     ///< [Hz]
  double inclusion{5};  ///< [mm], top of it
};

inline constexpr std::array<std::string_view, 4> kSetGrips{"light", "mid", "firm", "arm"};

/// What add_case() labels a case with.
[[nodiscard]] const std::vector<std::string>& set_labels();
/// A number as settings and labels have it: nine digits.
[[nodiscard]] std::string nine_digit_text(double value);
/// The next case of `plan`: the standard palpation over such a path, by such a hand.
void add_case(Plan& plan, std::uint64_t seed, const SetDraw& draw, const PlanAsk& ask);

}  // namespace palp::lab
