#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

/// Limits of form, far outside of anything physical: proto/WIRE.md.
namespace palp::message {

inline constexpr std::uint64_t kSentAtMaxNs = 1ULL << 53U;  ///< [ns], 104 days
inline constexpr std::uint32_t kHoldMaxUs = 60'000'000;     ///< [us], a session ends before
inline constexpr std::uint64_t kNumberMax = 1ULL << 53U;    ///< of packets: 285,000 years at 1 kHz
inline constexpr double kLengthMax = 10;                    ///< [m]
inline constexpr double kSpeedMax = 1e3;                    ///< [m/s]
inline constexpr double kForceMax = 1e5;                    ///< [N]
inline constexpr double kSumMax = 1e9;                      ///< [J] and [sqrt(W) s]

inline constexpr std::uint64_t kNothingHeard = std::numeric_limits<std::uint64_t>::max();

/// Larger than any telegram of any codec, smaller than a datagram.
inline constexpr std::size_t kTelegramSizeMax = 1100;  ///< [bytes]

}  // namespace palp::message
