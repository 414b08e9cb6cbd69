#pragma once

#include <cstdint>

/// The only randomness in the house: counter-based, so a draw depends on (seed, stream, index)
/// alone and switching one user on or off changes nobody else's draws. All functions are pure.
namespace palp {

/// SplitMix64's output function (Steele, Lea, Flood 2014): a bijection with full avalanche.
[[nodiscard]] constexpr std::uint64_t random_mix(std::uint64_t z) noexcept {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// 64 well mixed bits (SplitMix64's finaliser applied to the three words in turn).
[[nodiscard]] std::uint64_t random_bits(std::uint64_t seed,
                                        std::uint64_t stream,
                                        std::uint64_t index) noexcept;

/// Uniform in [0, 1), 53 bits.
[[nodiscard]] double random_uniform(std::uint64_t seed,
                                    std::uint64_t stream,
                                    std::uint64_t index) noexcept;

/// Standard normal, by inversion: one draw, one value; |value| < 8.3.
[[nodiscard]] double random_normal(std::uint64_t seed,
                                   std::uint64_t stream,
                                   std::uint64_t index) noexcept;

/// The middle of one of 2^52 equal cells between 0 and 1: never either, as with 53 bits and a half,
/// which a double rounds, it could be.
[[nodiscard]] constexpr double random_middle(std::uint64_t bits) noexcept {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1.0p-52;
}

/// Quantile of the standard normal distribution, 0 < p < 1; relative error below 1e-15 times a few
/// (Wichura, algorithm AS 241, PPND16).
[[nodiscard]] double normal_quantile(double p) noexcept;

/// Cumulative distribution of the standard normal.
[[nodiscard]] double normal_cdf(double z) noexcept;

/// One stream of the generator, for who draws from it often: bits(index) is
/// random_bits(seed, stream, index), with the work on seed and stream done once.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) noexcept;

  [[nodiscard]] std::uint64_t bits(std::uint64_t index) const noexcept {
    return random_mix(key_ + (index + 1) * kGolden);
  }
  /// As random_uniform() and random_normal().
  [[nodiscard]] double uniform(std::uint64_t index) const noexcept {
    return static_cast<double>(bits(index) >> 11) * 0x1.0p-53;
  }
  [[nodiscard]] double normal(std::uint64_t index) const noexcept {
    return normal_quantile(random_middle(bits(index)));
  }

 private:
  static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  std::uint64_t key_;
};

}  // namespace palp
