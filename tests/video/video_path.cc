#include "tests/video/video_path.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "netem/model/pipe.h"
#include "netem/syntax/impairment_text.h"
#include "tests/video/model_encoder.h"

namespace palp::video {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Duration kStep = microseconds{250};
constexpr Duration kForcePeriod = milliseconds{1};
constexpr std::size_t kForceSize = 200;  // [bytes] of a telegram: 228 on the wire
constexpr std::size_t kHeads = 32 + 28;  // [bytes]: header and tag, UDP and IP

enum class Kind : std::uint8_t { Force, Media };

/// What is in a test's datagram of force: its number and when it was sent.
struct ForceStamp {
  std::uint64_t number{};
  std::int64_t sent_ns{};
};

class Run {
 public:
  Run(const VideoPathSetup& setup, Encoder& encoder, const PictureOf& picture, const IsRight& right)
      : setup_{setup},
        picture_of_{picture},
        is_right_{right},
        pipe_{setup.up, setup.down, setup.seed, 1U << 16U},
        surgeon_{pipe_.surgeon_end()},
        patient_{pipe_.patient_end()},
        sender_{setup.rate, encoder} {
    const double bits = (kForceSize + 28) * 8.0;
    line_ = setup.one_way;
    if (setup.rate_mbps > 0) line_ += from_seconds(bits / (setup.rate_mbps * 1e6));
  }

  VideoPathResult run() {
    for (TimePoint now{}; now.time_since_epoch() < setup_.length; now += kStep) {
      if (now >= force_at_) send_force(now);
      if (setup_.with_video && now >= frame_at_) capture(now);
      while (const auto payload = sender_.next(now)) {
        send(*patient_, Kind::Media, *payload, now);
        wire_bytes_ += payload->size() + kHeads;
      }
      hear_at_surgeon(now);
      if (now >= report_at_) report(now);
      hear_at_patient(now);
    }
    finish();
    return std::move(result_);
  }

 private:
  static void send(link::Transport& end,
                   Kind kind,
                   std::span<const std::byte> body,
                   TimePoint now) {
    Bytes datagram{static_cast<std::byte>(kind)};
    datagram.insert(datagram.end(), body.begin(), body.end());
    // What header and tag would be.
    if (kind == Kind::Media) datagram.resize(datagram.size() + 31);
    (void)end.send(datagram, now);
  }

  void send_force(TimePoint now) {
    const ForceStamp stamp{.number = force_number_++, .sent_ns = now.time_since_epoch().count()};
    Bytes body(kForceSize - 1);
    std::memcpy(body.data(), &stamp, sizeof stamp);
    send(*patient_, Kind::Force, body, now);
    force_at_ += kForcePeriod;
  }

  void capture(TimePoint now) {
    frame_at_ += RateControl::kFramePeriod;
    if (!sender_.wants_picture(now)) return;
    const auto number = static_cast<std::uint32_t>(sender_.counts().frames);
    const Duration at = now.time_since_epoch();
    sender_.take(picture_of_(number, at), at, now + milliseconds{2});  // what encoding takes
  }

  void hear_at_surgeon(TimePoint now) {
    std::array<std::byte, link::kDatagramSizeMax> buffer{};
    while (const auto datagram = surgeon_->receive(buffer, now)) {
      const std::span<const std::byte> bytes{buffer.data(), datagram->size};
      if (bytes[0] == static_cast<std::byte>(Kind::Force)) {
        hear_force(bytes.subspan(1), datagram->arrived_at);
      } else if (const auto frame =
                     receiver_.hear(bytes.subspan(1, bytes.size() - 32), datagram->arrived_at)) {
        show(*frame, datagram->arrived_at);
      }
    }
  }

  void hear_force(std::span<const std::byte> body, TimePoint arrived_at) {
    ForceStamp stamp;
    std::memcpy(&stamp, body.data(), sizeof stamp);
    const TimePoint sent_at{Duration{stamp.sent_ns}};
    standing_.add(stamp.number, arrived_at - sent_at, arrived_at);
    if (sent_at.time_since_epoch() < setup_.judged_from) return;
    result_.force_excess_ms.push_back(1e3 * seconds(arrived_at - sent_at - line_));
    result_.force_arrived_s.push_back(seconds(arrived_at.time_since_epoch()));
  }

  void show(const ReceivedFrame& frame, TimePoint now) {
    if (!is_right_(frame)) ++result_.wrong;
    const TimePoint captured_at{frame.captured};
    if (now.time_since_epoch() >= setup_.judged_from) {
      result_.frame_delay_ms.push_back(1e3 * seconds(now - captured_at - setup_.one_way));
      const Duration pause = now - shown_at_;
      if (pause > milliseconds{100}) frozen_ += pause - RateControl::kFramePeriod;
      ++shown_;
    }
    shown_at_ = now;
  }

  void report(TimePoint now) {
    report_at_ += StandingDelay::kStep;
    StandingDelay::Reading force = standing_.read(now);
    if (!setup_.with_control) force.standing = Duration{0};
    send(*surgeon_, Kind::Media, write(receiver_.report(force)), now);
  }

  void hear_at_patient(TimePoint now) {
    std::array<std::byte, link::kDatagramSizeMax> buffer{};
    while (const auto datagram = patient_->receive(buffer, now)) {
      const std::span<const std::byte> bytes{buffer.data(), datagram->size};
      const auto message = read_media(bytes.subspan(1, bytes.size() - 32));
      if (message) sender_.hear(std::get<Report>(*message), 2 * setup_.one_way, now);
    }
    if (sender_.rate().off(now)) off_ += kStep;
  }

  void finish() {
    const Duration span = setup_.length - setup_.judged_from;
    if (const Duration rest = TimePoint{setup_.length} - shown_at_; rest > milliseconds{100}) {
      frozen_ += rest;
    }
    result_.frozen_share = seconds(frozen_) / seconds(span);
    result_.fps = static_cast<double>(shown_) / seconds(span);
    result_.wire_kbps = 8e-3 * static_cast<double>(wire_bytes_) / seconds(setup_.length);
    result_.force_dropped = pipe_.channel(netem::Direction::Down).counters().over_limit;
    result_.off_share = seconds(off_) / seconds(setup_.length);
    result_.sent = sender_.counts();
    result_.received = receiver_.counts();
  }

  VideoPathSetup setup_;
  const PictureOf& picture_of_;
  const IsRight& is_right_;
  netem::Pipe pipe_;
  std::unique_ptr<link::Transport> surgeon_;
  std::unique_ptr<link::Transport> patient_;
  Sender sender_;
  Receiver receiver_;
  StandingDelay standing_;
  Duration line_{};
  TimePoint force_at_{};
  TimePoint frame_at_{milliseconds{100}};
  TimePoint report_at_{milliseconds{50}};
  TimePoint shown_at_{setup_.judged_from};
  std::uint64_t force_number_{};
  std::uint64_t wire_bytes_{};
  std::uint64_t shown_{};
  Duration frozen_{};
  Duration off_{};
  VideoPathResult result_;
};

}  // namespace

VideoPathResult run_video_path(const VideoPathSetup& setup,
                               Encoder& encoder,
                               const PictureOf& picture_of,
                               const IsRight& is_right) {
  return Run{setup, encoder, picture_of, is_right}.run();
}

VideoPathResult run_video_path(const VideoPathSetup& setup) {
  ModelEncoder encoder{setup.seed};
  ModelDecoder decoder;
  const Picture none;
  return run_video_path(
      setup,
      encoder,
      [&](std::uint32_t /*number*/, Duration /*at*/) -> const Picture& { return none; },
      [&](const ReceivedFrame& frame) { return decoder.decode(frame.bytes); });
}

VideoPathSetup video_path(const std::string& words, Duration one_way, double rate_mbps) {
  const std::string delay =
      "delay " + std::to_string(one_way / microseconds{1}) + "us " + words + " order keep";
  std::string down = delay;
  if (rate_mbps > 0) {
    down += " rate " + std::to_string(static_cast<int>(rate_mbps * 1000)) + "kbit queue time 200ms";
  }
  const auto up = netem::parse_impairment(delay);
  const auto back = netem::parse_impairment(down);
  if (!up || !back) throw std::runtime_error{up ? back.error().text : up.error().text};
  VideoPathSetup setup;
  setup.up.impairment = *up;
  setup.down.impairment = *back;
  setup.one_way = one_way;
  setup.rate_mbps = rate_mbps;
  return setup;
}

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(values.size() - 1, at)];
}

}  // namespace palp::video
