#include "video/parity.h"

#include <array>
#include <cstdint>
#include <utility>

#include "common/core/check.h"

namespace palp::video {
namespace {

/// Products of the field, by table.
class Field {
 public:
  Field() noexcept {
    unsigned power = 1;
    for (unsigned i = 0; i < 255; ++i) {
      power_[i] = power_[i + 255] = static_cast<std::uint8_t>(power);
      log_[power] = static_cast<std::uint8_t>(i);
      power <<= 1U;
      if ((power & 0x100U) != 0) power ^= 0x11dU;
    }
    for (unsigned a = 1; a < 256; ++a) {
      for (unsigned b = 1; b < 256; ++b) product_[a][b] = power_[log_[a] + log_[b]];
    }
  }
  [[nodiscard]] std::uint8_t inverse(std::uint8_t a) const noexcept {
    return power_[255U - log_[a]];
  }
  [[nodiscard]] std::uint8_t product(std::uint8_t a, std::uint8_t b) const noexcept {
    return product_[a][b];
  }
  /// `to` += `factor` * `from`.
  void add(Bytes& to, const Bytes& from, std::uint8_t factor) const noexcept {
    const auto& times = product_[factor];
    for (std::size_t i = 0; i < to.size(); ++i) {
      to[i] ^= std::byte{times[std::to_integer<std::uint8_t>(from[i])]};
    }
  }
  void scale(Bytes& bytes, std::uint8_t factor) const noexcept {
    const auto& times = product_[factor];
    for (std::byte& byte : bytes) byte = std::byte{times[std::to_integer<std::uint8_t>(byte)]};
  }

 private:
  std::array<std::uint8_t, 510> power_{};
  std::array<std::uint8_t, 256> log_{};
  std::array<std::array<std::uint8_t, 256>, 256> product_{};
};

const Field& field() {
  static const Field kField;
  return kField;
}

/// Rows count down from 255 and columns up from 0: with 128 fragments at most they never meet.
std::uint8_t cauchy(std::size_t row, std::size_t column) noexcept {
  return field().inverse(static_cast<std::uint8_t>((255U - row) ^ column));
}

using Matrix = std::vector<std::vector<std::uint8_t>>;

/// Gauss and Jordan; `right` becomes the solution. Each square part of a Cauchy matrix is regular.
void solve(Matrix& left, std::vector<Bytes>& right) {
  const std::size_t size = right.size();
  for (std::size_t column = 0; column < size; ++column) {
    std::size_t pivot = column;
    while (left[pivot][column] == 0) ++pivot;
    std::swap(left[pivot], left[column]);
    std::swap(right[pivot], right[column]);
    const std::uint8_t scale = field().inverse(left[column][column]);
    for (std::uint8_t& value : left[column]) value = field().product(scale, value);
    field().scale(right[column], scale);
    for (std::size_t row = 0; row < size; ++row) {
      const std::uint8_t factor = left[row][column];
      if (row == column || factor == 0) continue;
      for (std::size_t i = 0; i < size; ++i) {
        left[row][i] ^= field().product(factor, left[column][i]);
      }
      field().add(right[row], right[column], factor);
    }
  }
}

}  // namespace

std::vector<Bytes> make_parity(const std::vector<Bytes>& data, std::size_t count) {
  PALP_CHECK(!data.empty() && data.size() + count <= kFragmentsMax, "fragments of one frame");
  std::vector<Bytes> parity(count, Bytes(data.front().size()));
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t column = 0; column < data.size(); ++column) {
      field().add(parity[row], data[column], cauchy(row, column));
    }
  }
  return parity;
}

bool repair(std::vector<Bytes>& fragments, std::size_t data_count) {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < data_count; ++i) {
    if (fragments[i].empty()) missing.push_back(i);
  }
  Matrix left;
  std::vector<Bytes> right;
  for (std::size_t row = 0; row + data_count < fragments.size(); ++row) {
    if (right.size() == missing.size()) break;
    const Bytes& parity = fragments[data_count + row];
    if (parity.empty()) continue;
    right.push_back(parity);
    for (std::size_t i = 0; i < data_count; ++i) {
      if (!fragments[i].empty()) field().add(right.back(), fragments[i], cauchy(row, i));
    }
    left.emplace_back();
    for (const std::size_t i : missing) left.back().push_back(cauchy(row, i));
  }
  if (right.size() < missing.size()) return false;
  solve(left, right);
  for (std::size_t i = 0; i < missing.size(); ++i) fragments[missing[i]] = std::move(right[i]);
  return true;
}

}  // namespace palp::video
