#pragma once

#include <cstdint>

/// The only randomness in the house: counter-based, so a draw depends on (seed, stream, index)
/// alone and switching one user on or off changes nobody else's draws. All functions are pure.
namespace palp {

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

/// Quantile of the standard normal distribution, 0 < p < 1; relative error below 1e-15 times a few
/// (Wichura, algorithm AS 241, PPND16).
[[nodiscard]] double normal_quantile(double p) noexcept;

/// Cumulative distribution of the standard normal.
[[nodiscard]] double normal_cdf(double z) noexcept;

}  // namespace palp
