#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/core/time.h"
#include "video/encoder.h"
#include "video/media_wire.h"
#include "video/rate_control.h"

namespace palp::video {

struct SenderCounts {
  std::uint64_t frames{};
  std::uint64_t keys{};
  std::uint64_t recoveries{};  ///< asked of the encoder
  std::uint64_t skipped{};     ///< pictures left out for the rate, a queue or an encoder
  std::uint64_t bytes{};       ///< of frames
  std::uint64_t fragments{};
};

/// The patient's end: decides which pictures are encoded and how, cuts frames into fragments, adds
/// parity and says when each may leave. Knows no socket and no clock: virtual time is as good as
/// real. Thread: one.
class Sender {
 public:
  /// `encoder` outlives it.
  Sender(const RateConfig& config, Encoder& encoder);

  /// A picture would be encoded: asked for at each of the camera's, in order.
  [[nodiscard]] bool wants_picture(TimePoint now);
  /// Encodes it and puts its fragments in line. `captured`: since the session began. @returns the
  /// frame, unless it was left out.
  std::optional<EncodedFrame> take(const Picture& picture, Duration captured, TimePoint now);
  /// The surgeon's report. `round_trip`: of the link, 0: not known.
  void hear(const Report& report, Duration round_trip, TimePoint now);
  /// The next payload that may leave by `now`; nullopt: none.
  [[nodiscard]] std::optional<Bytes> next(TimePoint now);
  /// When the next one may; nullopt: none waits.
  [[nodiscard]] std::optional<TimePoint> next_at() const;

  [[nodiscard]] VideoState state(TimePoint now) const noexcept {
    return rate_.off(now) ? VideoState::PathFull : VideoState::Sending;
  }
  [[nodiscard]] const RateControl& rate() const noexcept { return rate_; }
  [[nodiscard]] const SenderCounts& counts() const noexcept { return counts_; }

 private:
  static constexpr std::size_t kSentMax = 1024;

  struct Sent {
    std::uint32_t frame{};
    bool used{};
    bool acknowledged{};
    FrameNature nature;
  };
  struct Waiting {
    TimePoint at{};
    Bytes payload;
  };

  [[nodiscard]] Sent& sent(std::uint32_t frame) noexcept { return sent_[frame % kSentMax]; }
  [[nodiscard]] FrameOrder order(TimePoint now) noexcept;
  [[nodiscard]] std::uint16_t refers_back(const FrameNature& nature) const noexcept;
  void acknowledge(std::uint32_t frame);
  void put_in_line(const EncodedFrame& frame, Duration captured, TimePoint now);
  [[nodiscard]] std::size_t parity_expected() const noexcept;

  Encoder& encoder_;
  RateControl rate_;
  ParityPlan parity_;
  std::array<Sent, kSentMax> sent_{};
  std::uint32_t next_frame_{};
  std::optional<std::uint32_t> long_term_;  ///< frame that the other side keeps
  bool key_wanted_{true};
  bool recovers_{};  ///< the next frame refers to the long-term reference
  int since_key_{};  ///< frames
  std::optional<TimePoint> key_at_;
  std::optional<TimePoint> recovery_at_;
  bool watched_{true};
  Duration round_trip_{};
  int phase_{};  ///< of the camera's pictures
  std::deque<Waiting> line_;
  TimePoint line_free_at_{TimePoint::min()};
  SenderCounts counts_;
};

}  // namespace palp::video
