#pragma once

#include <cstddef>
#include <vector>

/// Systematic Reed-Solomon code over GF(256) with a Cauchy matrix: of k data and m parity fragments
/// any k give the data back (Bloemer et al., "An XOR-based erasure-resilient coding scheme", 1995).
/// The field is that of x^8 + x^4 + x^3 + x^2 + 1. Pure.
namespace palp::video {

using Bytes = std::vector<std::byte>;

/// More fragments than these, data and parity together, a frame never has.
inline constexpr std::size_t kFragmentsMax = 128;

/// `data`: at least one, all equally long. @returns `count` fragments of the same length;
/// data.size() + count <= kFragmentsMax (PALP_CHECK).
[[nodiscard]] std::vector<Bytes> make_parity(const std::vector<Bytes>& data, std::size_t count);

/// `fragments`: `data_count` data ones, then the parity; what is missing is empty, the others are
/// equally long. Fills in the missing data. @returns false: too few are there.
[[nodiscard]] bool repair(std::vector<Bytes>& fragments, std::size_t data_count);

}  // namespace palp::video
