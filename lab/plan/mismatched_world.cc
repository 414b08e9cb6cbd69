#include "lab/plan/mismatched_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/formatted.h"
#include "common/core/random.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kWorldDraws = 0x6d69'736d'6174'6300ULL;  // "mismatc"
constexpr double kBlockHeight = 57e-3;                           // [m], of the database
constexpr double kFloor = 2e-3;                                  // [m], below a ball

class WorldDraws {
 public:
  WorldDraws(std::uint64_t seed, std::uint64_t index) : stream_{seed, kWorldDraws + index} {}
  double between(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  double log_between(double low, double high) {
    return low * std::pow(high / low, stream_.uniform(next_++));
  }
  std::uint64_t seed() { return stream_.bits(next_++) >> 12; }

 private:
  RandomStream stream_;
  std::uint64_t next_{};
};

std::string ball_words(const MismatchedWorld& world, const Place& axis) {
  return formatted("; ball depth=%.9g radius=%.9g ratio=%.9g at=%.9g,%.9g",
                   1e3 * world.depth,
                   1e3 * world.radius,
                   world.ratio,
                   1e3 * axis.x,
                   1e3 * axis.y);
}

/// Words of the part that is not as assumed; the rest goes into `world`.
std::string words_of(Mismatch kind, double height, WorldDraws& draws, MismatchedWorld& world) {
  const double e_kpa = draws.between(12, 18);
  const std::string block = formatted("block e_kpa=%.9g", e_kpa);
  switch (kind) {
    case Mismatch::Stiffness: {
      const double spread = draws.between(0.05, 0.1);
      const double length = draws.log_between(6, 20);
      return block + formatted(" varies=%.9g length=%.9g seed=%llu",
                               spread,
                               length,
                               static_cast<unsigned long long>(draws.seed() >> 12));
    }
    case Mismatch::Relaxing: {
      const double share = draws.between(0.05, 0.3);
      return block +
             formatted("; relaxes share=%.9g time_s=%.9g", share, draws.log_between(0.3, 3));
    }
    case Mismatch::Exponential:
      return block + " law=exponential";
    case Mismatch::Layered:
      return block + " law=layered";
    case Mismatch::ThinBlock:
      return block + formatted(" height=%.9g", 1e3 * height);
    case Mismatch::TwoBalls:
      return block;
    case Mismatch::Breathing:
      world.breathing_amplitude = draws.between(0.3e-3, 1.5e-3);
      world.breathing_frequency = draws.between(0.15, 0.4);
      return block;
    case Mismatch::Slope: {
      const double slope = draws.between(5, 15);
      const double towards = draws.between(0, 2 * std::numbers::pi);
      return block + formatted("; surface slope_x=%.9g slope_y=%.9g",
                               slope * std::cos(towards),
                               slope * std::sin(towards));
    }
    case Mismatch::Dome:
      return block + formatted("; surface radius=%.9g", draws.between(40, 120));
    case Mismatch::SensorPole:
      world.sensor_pole = draws.between(6, 12);
      return block;
  }
  return block;
}

/// Beside the first one, and as large.
Place second_axis(const MismatchedWorld& world, WorldDraws& draws) {
  const double away = std::max(draws.between(25e-3, 40e-3), 4.2 * world.radius);
  const double towards = draws.between(0, 2 * std::numbers::pi);
  return {world.axis.x + away * std::cos(towards), world.axis.y + away * std::sin(towards)};
}

}  // namespace

MismatchedWorld mismatched_world(std::uint64_t seed, std::uint64_t index, double half) {
  constexpr std::size_t kKinds = kMismatchNames.size();
  WorldDraws draws{seed, index};
  MismatchedWorld world;
  world.kind = static_cast<Mismatch>(index % kKinds);
  const bool two = world.kind == Mismatch::TwoBalls;
  world.inclusion = two || index / kKinds % 3 != 2;
  world.axis = {draws.between(-half, half), draws.between(-half, half)};
  const double height =
      world.kind == Mismatch::ThinBlock ? draws.between(20e-3, 40e-3) : kBlockHeight;
  world.depth = draws.between(4e-3, std::min(20e-3, height - kFloor - 8e-3));
  world.radius =
      draws.between(4e-3, std::min(two ? 9e-3 : 14e-3, 0.5 * (height - kFloor - world.depth)));
  world.ratio = draws.log_between(5, 900);
  world.phantom = words_of(world.kind, height, draws, world);
  if (world.inclusion) world.phantom += ball_words(world, world.axis);
  if (two) world.phantom += ball_words(world, second_axis(world, draws));
  return world;
}

}  // namespace palp::lab
