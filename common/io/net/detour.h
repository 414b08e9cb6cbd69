#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

namespace palp::io {

/// The peer's ways beside that of its own address, while another address is still being proven: its
/// telegrams come through io, and what rt sends goes there as well. As long as the peer's own
/// address delivers, nothing of this happens: who copies telegrams and is faster than their sender
/// gets nothing for it. For each byte that came from there two may go back; a third is io's, for
/// its questions. A value. Thread: rt.
class Detour {
 public:
  static constexpr std::size_t kShare = 2;   ///< bytes for each byte that came
  static constexpr std::size_t kPlaces = 2;  ///< the sender's, and that of who copies it
  /// Without a telegram over the peer's own address: it may have left.
  static constexpr Duration kSilence = std::chrono::milliseconds{10};

  Detour() noexcept = default;
  /// `former`: the address that the peer had before this one. If it delivers after all, it is heard
  /// and told everything.
  explicit Detour(const Endpoint& former) noexcept : former_{former} {}

  /// Each tick; from the first on the peer's own address has its chance.
  void begin_tick(TimePoint now) noexcept {
    if (!straight_at_) straight_at_ = now;
  }
  /// A telegram of the peer's own address that bears the connection id of the session. It may be a
  /// copy of one that came by another way.
  void heard_straight(TimePoint now) noexcept { straight_at_ = now; }
  [[nodiscard]] TimePoint straight_at() const noexcept {
    return straight_at_.value_or(TimePoint{});
  }

  enum class Fate : std::uint8_t { Wait, Take, Drop };
  /// What to do with a telegram that came from elsewhere at that time.
  [[nodiscard]] Fate fate(const Endpoint& from,
                          TimePoint arrived_at,
                          TimePoint now) const noexcept {
    if (silent(now) || from == former_) return Fate::Take;
    return now - arrived_at > kSilence ? Fate::Drop : Fate::Wait;
  }
  /// One that was taken; io has opened it.
  void heard(const Endpoint& from, std::size_t size) noexcept {
    if (!(places_[0].to == from) && !(places_[1].to == from)) {
      places_[1] = places_[0];
      places_[0] = {.to = from};
    }
    Place& place = places_[places_[0].to == from ? 0 : 1];
    place.credit = std::min(place.credit + kShare * size, kCreditMax);
  }
  /// Where a copy of `size` bytes may go, if it may: then it counts. `at`: below kPlaces.
  [[nodiscard]] const Endpoint* spend(std::size_t at, std::size_t size, TimePoint now) noexcept {
    Place& place = places_[at];
    if (!silent(now) && !(place.to == former_)) return nullptr;
    if (size > place.credit) return nullptr;
    place.credit -= size;
    return &place.to;
  }

 private:
  static constexpr std::size_t kCreditMax = 4096;  ///< [bytes]; what is not used is soon forgotten

  struct Place {
    Endpoint to;
    std::size_t credit{};  ///< [bytes]
  };
  [[nodiscard]] bool silent(TimePoint now) const noexcept {
    return straight_at_ && now - *straight_at_ >= kSilence;
  }

  Endpoint former_;
  std::optional<TimePoint> straight_at_;
  std::array<Place, kPlaces> places_;
};

}  // namespace palp::io
