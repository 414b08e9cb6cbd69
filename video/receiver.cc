#include "video/receiver.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace palp::video {
namespace {

constexpr double kForgetting = 0.998;       // a frame
constexpr double kEnoughFrames = 20;        // before a quantile says anything
constexpr std::uint32_t kJudgedBehind = 6;  // frames: what of it is missing by then is lost
constexpr double kSmoothing = 0.3;

}  // namespace

std::optional<ReceivedFrame> Receiver::hear(std::span<const std::byte> bytes, TimePoint now) {
  const auto message = read_media(bytes);
  if (!message) {
    ++counts_.malformed;
    return std::nullopt;
  }
  if (const auto* fragment = std::get_if<Fragment>(&*message)) {
    peer_state_ = VideoState::Sending;
    return take(*fragment, now);
  }
  if (const auto* question = std::get_if<Question>(&*message)) challenge_ = question->challenge;
  if (const auto* word = std::get_if<Word>(&*message)) peer_state_ = word->state;
  return std::nullopt;
}

Receiver::Assembly* Receiver::assembly_of(const Fragment& fragment, TimePoint now) {
  const auto found = work_.find(fragment.frame);
  if (found != work_.end()) {
    const Fragment& first = found->second.first;
    const bool same = first.size == fragment.size && first.data_count == fragment.data_count &&
                      first.parity_count == fragment.parity_count &&
                      first.refers_back == fragment.refers_back && first.jpeg == fragment.jpeg &&
                      first.captured_ns == fragment.captured_ns;
    if (!same) ++counts_.malformed;
    return same ? &found->second : nullptr;
  }
  if (newest_delivered_ && fragment.frame <= *newest_delivered_) return nullptr;  // too late
  while (work_.size() >= kFramesInWork) {
    if (fragment.frame < work_.begin()->first) return nullptr;
    give_up(work_.begin()->first, work_.begin()->second);
    work_.erase(work_.begin());
  }
  Assembly& one = work_[fragment.frame];
  one.first = fragment;
  one.first.data = {};
  one.parts.resize(std::size_t{fragment.data_count} + fragment.parity_count);
  one.began_at = now;
  one.offset_first = fragment.offset_us;
  newest_seen_ = std::max(newest_seen_.value_or(0), fragment.frame);
  fragments_newest_ = one.parts.size();
  return &one;
}

std::optional<ReceivedFrame> Receiver::take(const Fragment& fragment, TimePoint now) {
  ++counts_.fragments;
  Assembly* const one = assembly_of(fragment, now);
  if (one == nullptr) return std::nullopt;
  if (one->complete) {  // not lost, if of no use any more
    one->arrived = std::min(one->arrived + 1, one->parts.size());
    return std::nullopt;
  }
  if (!one->parts[fragment.index].empty()) return std::nullopt;
  one->parts[fragment.index].assign(fragment.data.begin(), fragment.data.end());
  ++one->arrived;
  one->bytes += fragment.data.size() + 84;
  one->newest_at = now;
  one->offset_newest = std::max(one->offset_newest, fragment.offset_us);
  std::optional<ReceivedFrame> frame;
  if (one->arrived >= one->first.data_count) {
    one->complete = true;
    note_span(*one);
    frame = finish(*one);
  }
  // What came late of a frame that is whole still counts as arrived, for a while.
  while (!work_.empty() && work_.begin()->first + kJudgedBehind < newest_seen_.value_or(0)) {
    give_up(work_.begin()->first, work_.begin()->second);
    work_.erase(work_.begin());
  }
  return frame;
}

std::optional<ReceivedFrame> Receiver::finish(Assembly& one) {
  const std::uint32_t number = one.first.frame;
  if (newest_delivered_ && number <= *newest_delivered_) return std::nullopt;
  if (!one.first.key && !was_delivered(number - one.first.refers_back)) {
    ++counts_.undecodable;
    wants_recovery_ = true;
    return std::nullopt;
  }
  const std::size_t count = one.first.data_count;
  const bool whole = std::none_of(one.parts.begin(),
                                  one.parts.begin() + static_cast<std::ptrdiff_t>(count),
                                  [](const Bytes& part) { return part.empty(); });
  if (!whole) {
    if (!repair(one.parts, count)) return std::nullopt;
    ++counts_.repaired;
  }
  ReceivedFrame frame{.number = number,
                      .key = one.first.key,
                      .jpeg = one.first.jpeg,
                      .captured = Duration{static_cast<std::int64_t>(
                          std::min<std::uint64_t>(one.first.captured_ns, INT64_MAX))},
                      .bytes = {}};
  frame.bytes.reserve(one.first.size + kFragmentDataMax);
  for (std::size_t i = 0; i < count; ++i) {
    frame.bytes.insert(frame.bytes.end(), one.parts[i].begin(), one.parts[i].end());
  }
  frame.bytes.resize(one.first.size);
  delivered_[number % kRemembered] = number + 1;
  newest_delivered_ = number;
  wants_recovery_ = false;
  if (frame.key) wants_key_ = false;
  ++counts_.delivered;
  counts_.bytes += frame.bytes.size();
  return frame;
}

bool Receiver::was_delivered(std::uint32_t frame) const noexcept {
  return delivered_[frame % kRemembered] == frame + 1;
}

void Receiver::note_span(const Assembly& one) noexcept {
  const double sent = 1e-6 * (one.offset_newest - one.offset_first);  // [s]
  const double took = seconds(one.newest_at - one.began_at);
  if (one.arrived < 3 || sent <= 0 || took <= 0) return;
  const double arrived = static_cast<double>(one.arrived);
  const double kbps = static_cast<double>(one.bytes) * (arrived - 1) / arrived * 8e-3 / took;
  span_ratio_ += kSmoothing * (took / sent - span_ratio_);
  rate_kbps_ = rate_kbps_ == 0 ? kbps : rate_kbps_ + kSmoothing * (kbps - rate_kbps_);
}

/// Frames are judged in order: those of which nothing arrived lost as many as the one before had.
void Receiver::give_up(std::uint32_t frame, const Assembly& one) noexcept {
  const std::uint32_t from = judged_ ? *judged_ + 1 : frame;
  for (std::uint32_t unseen = std::max(from, frame - std::min(frame, 30U)); unseen < frame;
       ++unseen) {
    note_lost(fragments_newest_);
    ++counts_.incomplete;
  }
  if (!one.complete) ++counts_.incomplete;
  note_lost(one.parts.size() - one.arrived);
  judged_ = frame;
}

void Receiver::note_lost(std::size_t fragments) noexcept {
  for (double& weight : lost_) weight *= kForgetting;
  lost_[std::min(fragments, lost_.size() - 1)] += 1;
}

std::uint8_t Receiver::lost_quantile() const noexcept {
  double all = 0;
  for (const double weight : lost_) all += weight;
  if (all < kEnoughFrames) return 0;
  double sum = 0;
  std::size_t count = 0;
  for (; count + 1 < lost_.size(); ++count) {
    sum += lost_[count];
    if (sum >= 0.995 * all) break;
  }
  return static_cast<std::uint8_t>(count);
}

Report Receiver::report(const StandingDelay::Reading& force) noexcept {
  Report report{.wants_recovery = wants_recovery_, .wants_key = wants_key_, .unwatched = !watched_};
  if (newest_delivered_) {
    report.newest_delivered = *newest_delivered_;
    for (std::uint32_t i = 0; i < 32 && i <= *newest_delivered_; ++i) {
      if (was_delivered(*newest_delivered_ - i)) report.delivered_before |= 1U << i;
    }
  }
  const auto standing = force.standing / std::chrono::microseconds{10};
  report.standing_10us =
      static_cast<std::int16_t>(std::clamp<std::int64_t>(standing, 0, INT16_MAX));
  if (force.expected > 0) {
    const double arrived = static_cast<double>(force.arrived);
    const double lost = 1 - arrived / static_cast<double>(force.expected);
    report.lost = static_cast<std::uint16_t>(65535 * std::clamp(lost, 0.0, 1.0));
  }
  report.span_ratio = static_cast<std::uint16_t>(std::clamp(256 * span_ratio_, 0.0, 65535.0));
  report.rate_kbps = static_cast<std::uint32_t>(std::clamp(rate_kbps_, 0.0, 1e6));
  report.fragments_lost = lost_quantile();
  report.echo = 0;
  return report;
}

}  // namespace palp::video
