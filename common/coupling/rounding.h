#pragma once

namespace palp::coupling {

/// Ratio of noise to quantum [-], 0.01 to 20, of a rounding sensor, from the mean square of its
/// readings of no force over the square of its quantum. Some 40 x 8 error functions: once a
/// session.
[[nodiscard]] double noise_over_quantum(double mean_square_over_quantum) noexcept;

}  // namespace palp::coupling
