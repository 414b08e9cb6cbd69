#include "video/sender.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palp::video {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr double kCameraFps = 30;
/// A line so much behind takes no new frame.
constexpr Duration kBehindMax = milliseconds{100};
/// Never two fragments within it: at each the force telegrams have their turn.
constexpr Duration kGapMin = milliseconds{1};
constexpr Duration kKeyPause = std::chrono::seconds{2};
constexpr Duration kRecoveryPause = milliseconds{70};  ///< beyond a round trip
/// A key frame has to be small, and gets sharp within a second.
constexpr double kSoftKbps = 200;
constexpr double kSharpening = 1.12;    ///< a frame
constexpr double kOfTarget = 0.92;      ///< what the encoder is told: its mean runs over
constexpr std::size_t kHeadsSize = 84;  ///< [bytes], of a fragment, with IP and UDP

}  // namespace

Sender::Sender(const RateConfig& config, Encoder& encoder) : encoder_{encoder}, rate_{config} {}

bool Sender::wants_picture(TimePoint now) {
  const bool turn = phase_++ % rate_.stride() == 0;
  if (!turn || !watched_) return false;
  if (rate_.holds(now) || line_free_at_ > now + kBehindMax) {
    ++counts_.skipped;
    return false;
  }
  return true;
}

std::size_t Sender::parity_expected() const noexcept {
  const double frame = rate_.target() * 125.0 * rate_.stride() / kCameraFps;  // [bytes]
  const auto data = static_cast<std::size_t>(std::ceil(frame / kFragmentDataMax));
  return parity_.count(std::max<std::size_t>(1, data), rate_.loss(), round_trip_);
}

FrameOrder Sender::order(TimePoint now) noexcept {
  FrameOrder order;
  order.key = key_wanted_;
  order.soft = order.key;
  if (order.key) {
    since_key_ = 0;
    key_at_ = now;
    key_wanted_ = false;
  }
  const double fps = kCameraFps / rate_.stride();
  const double soft = kSoftKbps * std::pow(kSharpening, std::min(since_key_++, 100));
  const double frame = rate_.target() * 125.0 / fps / kFragmentDataMax;  // [fragments]
  const double parity = static_cast<double>(parity_expected()) / std::max(1.0, frame);
  order.kbps = std::max(40.0, std::min(rate_.target(), soft) * kOfTarget / (1 + parity));
  order.fps = fps;
  return order;
}

std::uint16_t Sender::refers_back(const FrameNature& nature) const noexcept {
  if (nature.key) return 0;
  const bool to_long_term = recovers_ && nature.refers_to_long_term && long_term_;
  const std::uint32_t back = to_long_term ? next_frame_ - *long_term_ : 1;
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(back, 0xFFFF));
}

std::optional<EncodedFrame> Sender::take(const Picture& picture, Duration captured, TimePoint now) {
  auto frame = encoder_.encode(picture, order(now));
  if (!frame || frame->bytes.empty() || frame->bytes.size() > kFrameSizeMax) {
    key_wanted_ = key_wanted_ || !frame || frame->bytes.size() > kFrameSizeMax;
    ++counts_.skipped;
    return std::nullopt;
  }
  put_in_line(*frame, captured, now);
  return frame;
}

void Sender::put_in_line(const EncodedFrame& frame, Duration captured, TimePoint now) {
  const std::size_t size = frame.bytes.size();
  const std::size_t count = (size + kFragmentDataMax - 1) / kFragmentDataMax;
  const std::size_t each = (size + count - 1) / count;
  std::vector<Bytes> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = frame.bytes.begin() + static_cast<std::ptrdiff_t>(std::min(size, i * each));
    const auto end =
        frame.bytes.begin() + static_cast<std::ptrdiff_t>(std::min(size, (i + 1) * each));
    parts.emplace_back(begin, end).resize(each);
  }
  const std::size_t spare = parity_.count(count, rate_.loss(), round_trip_);
  for (Bytes& parity : make_parity(parts, spare)) parts.push_back(std::move(parity));

  Fragment head;
  head.jpeg = frame.jpeg;
  head.refers_back = refers_back(frame.nature);
  head.key = head.refers_back == 0;
  head.frame = next_frame_;
  head.captured_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, captured.count()));
  head.size = static_cast<std::uint32_t>(size);
  head.data_count = static_cast<std::uint8_t>(count);
  head.parity_count = static_cast<std::uint8_t>(spare);
  const double wire_bits = 8.0 * static_cast<double>(each + kHeadsSize);
  const Duration gap = std::max(kGapMin, from_seconds(wire_bits / (1000.0 * rate_.pace())));
  const TimePoint begins = std::max(now, line_free_at_);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Duration offset = gap * static_cast<std::int64_t>(i);
    head.index = static_cast<std::uint8_t>(i);
    head.offset_us =
        static_cast<std::uint16_t>(std::min<std::int64_t>(offset / microseconds{1}, 0xFFFF));
    head.data = parts[i];
    line_.push_back({begins + offset, write(head)});
  }
  line_free_at_ = begins + gap * static_cast<std::int64_t>(parts.size());

  sent(next_frame_) = {.frame = next_frame_, .used = true, .nature = frame.nature};
  ++next_frame_;
  recovers_ = false;
  ++counts_.frames;
  counts_.keys += head.key ? 1 : 0;
  counts_.bytes += size;
  counts_.fragments += parts.size();
}

void Sender::acknowledge(std::uint32_t frame) {
  Sent& one = sent(frame);
  if (!one.used || one.frame != frame || std::exchange(one.acknowledged, true)) return;
  if (!one.nature.marks) return;
  encoder_.acknowledge(one.nature);
  // From the third mark on an encoder marks the frame before the one that says so.
  const bool before = one.nature.marked_frame_num != one.nature.frame_num && frame > 0;
  long_term_ = frame - (before ? 1 : 0);
}

void Sender::hear(const Report& report, Duration round_trip, TimePoint now) {
  // Of frames that were never sent nothing is believed.
  const bool plausible =
      report.newest_delivered == Report::kNone || report.newest_delivered < next_frame_;
  if (!plausible) return;
  watched_ = !report.unwatched;
  round_trip_ = round_trip;
  rate_.hear(report, round_trip, now);
  parity_.hear(report);
  const bool any = report.newest_delivered != Report::kNone;
  for (std::uint32_t i = 32; any && i-- > 0;) {
    const bool delivered = (report.delivered_before >> i & 1U) != 0;
    if (delivered && i <= report.newest_delivered) acknowledge(report.newest_delivered - i);
  }
  const bool lasting = !key_at_ || now - *key_at_ > kKeyPause;
  if (report.wants_key && lasting) key_wanted_ = true;
  if (!report.wants_recovery || next_frame_ == 0) return;
  if (recovery_at_ && now - *recovery_at_ <= round_trip + kRecoveryPause) return;
  recovery_at_ = now;
  if (long_term_ && any) {
    encoder_.recover(sent(report.newest_delivered).nature, sent(next_frame_ - 1).nature);
    recovers_ = true;
    ++counts_.recoveries;
  } else if (lasting) {
    key_wanted_ = true;
  }
}

std::optional<Bytes> Sender::next(TimePoint now) {
  if (line_.empty() || line_.front().at > now) return std::nullopt;
  std::optional<Bytes> payload{std::move(line_.front().payload)};
  line_.pop_front();
  // Who was late does not catch up in a burst.
  if (!line_.empty()) line_.front().at = std::max(line_.front().at, now + kGapMin);
  return payload;
}

std::optional<TimePoint> Sender::next_at() const {
  if (line_.empty()) return std::nullopt;
  return line_.front().at;
}

}  // namespace palp::video
