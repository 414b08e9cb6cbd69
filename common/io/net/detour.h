#pragma once

#include <algorithm>
#include <cstddef>

#include "common/io/net/endpoint.h"

namespace palp::io {

/// The peer's way while its new address is still being proven: its telegrams come through io, and
/// what rt sends goes there as well as to the old address. For each byte that came from there two
/// may go back; a third is io's, for its questions. A value. Thread: rt.
class Detour {
 public:
  static constexpr std::size_t kShare = 2;  ///< bytes for each byte that came

  void heard(const Endpoint& from, std::size_t size) noexcept {
    if (!(from == to_)) credit_ = 0;
    to_ = from;
    credit_ = std::min(credit_ + kShare * size, kCreditMax);
  }
  /// Whether `size` bytes may go to(); if so they count.
  [[nodiscard]] bool spend(std::size_t size) noexcept {
    if (size > credit_) return false;
    credit_ -= size;
    return true;
  }
  [[nodiscard]] const Endpoint& to() const noexcept { return to_; }

 private:
  static constexpr std::size_t kCreditMax = 4096;  ///< [bytes]; what is not used is soon forgotten
  Endpoint to_;
  std::size_t credit_{};  ///< [bytes]
};

}  // namespace palp::io
