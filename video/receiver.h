#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/core/time.h"
#include "video/media_wire.h"
#include "video/standing_delay.h"

namespace palp::video {

/// A frame whose reference was delivered too.
struct ReceivedFrame {
  std::uint32_t number{};
  bool key{};
  bool jpeg{};
  Duration captured{};  ///< since the peer's session began
  Bytes bytes;
};

struct ReceiverCounts {
  std::uint64_t fragments{};
  std::uint64_t malformed{};  ///< breaks a rule of form, or contradicts its frame's first
  std::uint64_t delivered{};
  std::uint64_t repaired{};     ///< of these, by parity
  std::uint64_t undecodable{};  ///< whole, but what it refers to is missing
  std::uint64_t incomplete{};   ///< given up
  std::uint64_t bytes{};        ///< of frames delivered
};

/// The surgeon's end: puts frames together, repairs them, delivers those that can be decoded, at
/// once and in order, and says what it got. A frame that comes after a newer one is dropped;
/// nothing waits. Any bytes may come in. Thread: one.
class Receiver {
 public:
  /// `bytes`: a payload, opened. @returns a frame that is now to be shown.
  [[nodiscard]] std::optional<ReceivedFrame> hear(std::span<const std::byte> bytes, TimePoint now);
  /// What to answer every StandingDelay::kStep. `force`: of the telegrams beside.
  [[nodiscard]] Report report(const StandingDelay::Reading& force) noexcept;
  /// The next reports ask for a frame that refers to nothing, until one is delivered.
  void want_key() noexcept { wants_key_ = true; }
  void set_watched(bool watched) noexcept { watched_ = watched; }

  [[nodiscard]] const ReceiverCounts& counts() const noexcept { return counts_; }
  /// Challenge of a question since the last call; 0: none.
  [[nodiscard]] std::uint64_t take_challenge() noexcept { return std::exchange(challenge_, 0); }
  /// What the peer said of its video last.
  [[nodiscard]] VideoState peer_state() const noexcept { return peer_state_; }

 private:
  static constexpr std::size_t kFramesInWork = 8;
  static constexpr std::uint32_t kRemembered = 1024;

  struct Assembly {
    Fragment first;  ///< its data is not looked at
    std::vector<Bytes> parts;
    std::size_t arrived{};
    std::size_t bytes{};
    bool complete{};
    TimePoint began_at{};
    TimePoint newest_at{};
    std::uint16_t offset_first{};   ///< [us]
    std::uint16_t offset_newest{};  ///< [us]
  };

  [[nodiscard]] std::optional<ReceivedFrame> take(const Fragment& fragment, TimePoint now);
  [[nodiscard]] Assembly* assembly_of(const Fragment& fragment, TimePoint now);
  [[nodiscard]] std::optional<ReceivedFrame> finish(Assembly& one);
  void note_span(const Assembly& one) noexcept;
  void give_up(std::uint32_t frame, const Assembly& one) noexcept;
  void note_lost(std::size_t fragments) noexcept;
  [[nodiscard]] std::uint8_t lost_quantile() const noexcept;
  [[nodiscard]] bool was_delivered(std::uint32_t frame) const noexcept;

  std::map<std::uint32_t, Assembly> work_;
  std::array<std::uint32_t, kRemembered> delivered_{};  ///< frame + 1, by frame
  std::optional<std::uint32_t> newest_delivered_;
  std::optional<std::uint32_t> newest_seen_;
  std::optional<std::uint32_t> judged_;  ///< up to there the losses of frames are counted
  bool wants_recovery_{};
  bool wants_key_{true};
  bool watched_{true};
  std::uint64_t challenge_{};
  VideoState peer_state_{VideoState::Silent};
  double span_ratio_{1};  ///< [-]
  double rate_kbps_{};    ///< [kbit/s]
  std::size_t fragments_newest_{4};
  std::array<double, 21> lost_{};  ///< [-], weight of frames that lost so many fragments, fading
  ReceiverCounts counts_;
};

}  // namespace palp::video
