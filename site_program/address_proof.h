#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

namespace palp::site_program {

/// Where pictures may go: to an address that has repeated what only it was asked. A report that
/// opens may have been sent on from elsewhere. An address that is heard is left for no other: who
/// is silent has moved, who is fast has not. Thread: one.
class AddressProof {
 public:
  static constexpr Duration kAskEvery = std::chrono::milliseconds{100};
  /// So long the proven address may be silent.
  static constexpr Duration kSilence = std::chrono::seconds{2};

  /// `draw`: 64 bits that nobody can guess.
  explicit AddressProof(std::function<std::uint64_t()> draw) : draw_{std::move(draw)} {}

  /// A report came from there; `echo`: what it repeats, 0: nothing. @returns what to ask it, if it
  /// is to be asked.
  std::optional<std::uint64_t> hear(const io::Endpoint& from, std::uint64_t echo, TimePoint now);
  /// None: nobody has.
  [[nodiscard]] const io::Endpoint& proven() const noexcept { return proven_; }
  /// It is not heard any more, or was never.
  [[nodiscard]] bool silent(TimePoint now) const noexcept {
    return !proven_.valid() || now - heard_at_ > kSilence;
  }

 private:
  std::function<std::uint64_t()> draw_;
  io::Endpoint proven_;
  TimePoint heard_at_{};
  io::Endpoint asked_;
  std::uint64_t challenge_{};
  TimePoint asked_at_{};
};

}  // namespace palp::site_program
