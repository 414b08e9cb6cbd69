// How much processor time a map takes once a stroke is there: the posterior of all touches, where
// to tap next, and the stiffness map. Patterns of 9, 25 and 49 places, five phantoms each. One line
// a pattern; exit code 1 if with 25 places a median is above 20, 50 or 10 ms.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <time.h>

#include "common/core/median.h"
#include "depth/map_estimator.h"
#include "depth/map_posterior.h"
#include "depth/next_touch.h"
#include "depth/stiffness_map.h"
#include "lab/plan/locate_taps.h"

namespace palp::lab {
namespace {

constexpr std::size_t kParts = 3;
constexpr std::array kNames{"posterior", "next touch", "stiffness map"};
constexpr std::array kTargets{20.0, 50.0, 10.0};  // [ms]
constexpr int kTargetSide = 5;

/// Time of this thread alone, so that what else runs on the machine does not count.
double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

std::vector<depth::PlaceData> touched(const depth::CurveBasis& basis,
                                      int side,
                                      std::uint32_t seed) {
  const std::string words = "block varies=0.05 seed=" + std::to_string(seed) +
                            "; ball depth=8 radius=12 ratio=200 at=3,-2";
  const auto phantom = patient::make_phantom(words);
  if (!phantom) {
    std::fprintf(stderr, "%s\n", phantom.error().text.c_str());
    std::exit(2);
  }
  LocateDraws draws{seed, 1};
  Palpation hand{basis, {}, [&](const Place& at, TimePoint now, const Feel& feel) {
                   return tap(
                       *phantom, {.start_place = at}, 4.2e-3, std::nullopt, draws, now, feel);
                 }};
  std::vector<depth::PlaceData> places;
  for (int i = 0; i < side * side; ++i) {
    const auto felt = hand.touch({7e-3 * (i % side - side / 2), 7e-3 * (i / side - side / 2)});
    if (felt) places.push_back(*felt);
  }
  return places;
}

int run() {
  const auto database = depth::default_database();
  if (!database) return 2;
  const depth::MapPrior prior;
  const depth::BallField field{*database, prior.ball, depth::lateral_share(*database)};
  const depth::CurveBasis basis{*database};
  bool held = true;
  for (const int side : {3, 5, 7}) {
    std::array<std::vector<double>, kParts> took;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const auto places = touched(basis, side, seed);
      const double begun = processor_ms();
      const depth::MapLikelihood likelihood{field, {}, places};
      const auto posterior = depth::map_posterior(likelihood, field, prior);
      const double told = processor_ms();
      const auto next = depth::next_touch(likelihood, field, posterior, 50e-3);
      const double suggested = processor_ms();
      const auto cells = depth::stiffness_map(likelihood, field, posterior);
      const double drawn = processor_ms();
      if (!next || cells.empty()) return 2;
      took[0].push_back(told - begun);
      took[1].push_back(suggested - told);
      took[2].push_back(drawn - suggested);
    }
    std::printf("%2d places:", side * side);
    for (std::size_t part = 0; part < kParts; ++part) {
      const double middle = *median(took[part]);
      std::printf("  %s %.1f ms", kNames[part], middle);
      held = held && (side != kTargetSide || middle <= kTargets[part]);
    }
    std::printf("\n");
  }
  return held ? 0 : 1;
}

}  // namespace
}  // namespace palp::lab

int main() { return palp::lab::run(); }
