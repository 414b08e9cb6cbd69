#pragma once

#include <string_view>

#include "tests/common/link/network_couple.h"
#include "tests/netem/model/impairment_builders.h"

namespace palp::link {

/// A share of 2 % lost, 3 in a row on average: Gilbert-Elliott's model with these rates.
inline constexpr std::string_view kBursts = "delay 20ms loss gemodel 0.680272% 33.3333%";
inline constexpr std::string_view kRandom = "delay 20ms loss 5%";

struct Repair {
  double lost{};     ///< [-], share of the telegrams
  double missing{};  ///< [-], share of the samples that were never handed over
};

/// From the surgeon, over a network that loses as `words` say.
inline Repair repair_over(std::string_view words, std::uint64_t samples, std::uint64_t seed) {
  const netem::PathPlan up{.impairment = netem::impaired(words)};
  NetworkCouple couple{up, {}, seed};
  std::uint64_t handed = 0;
  couple.patient.look = [&](const Arrivals& arrivals) {
    for (const Incoming& one : arrivals.samples) handed += one.number < samples ? 1 : 0;
  };
  couple.run(std::chrono::milliseconds{samples + 200});
  const auto all = static_cast<double>(samples);
  return {.lost = static_cast<double>(couple.patient.health.lost) / (all + 180),
          .missing = 1 - static_cast<double>(handed) / all};
}

}  // namespace palp::link
