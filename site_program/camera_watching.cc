#include "site_program/camera_watching.h"

#include <optional>
#include <system_error>
#include <utility>

#include "common/io/net/media_wait.h"
#include "common/io/realtime/steady_clock.h"
#include "video/media_seal.h"
#include "video/receiver.h"
#include "video/touch_hold.h"

namespace palp::site_program {
namespace {

using std::chrono::milliseconds;

constexpr Duration kWatchingRest = milliseconds{5};
/// While nothing answers.
constexpr Duration kKnockEvery = milliseconds{500};
constexpr Duration kSilent = std::chrono::seconds{3};
/// A machine whose own address has changed has a socket that leads nowhere.
constexpr Duration kAnotherSocketEvery = std::chrono::seconds{5};
constexpr Duration kTellEvery = milliseconds{250};
constexpr Duration kRateSpan = std::chrono::seconds{1};

}  // namespace

/// All that the thread owns.
class CameraWatching::Io {
 public:
  Io(bool records,
     io::MediaDoor& door,
     Mailbox<Duration>* touch_hold,
     CameraRecording& recording,
     monitor::CameraFeed& feed,
     std::function<void()> arrived)
      : records_{records},
        door_{door},
        touch_hold_{touch_hold},
        recording_{recording},
        feed_{feed},
        arrived_{std::move(arrived)} {}

  void work(TimePoint now);

 private:
  struct Session {
    explicit Session(io::MediaSession&& begun)
        : peer{begun.peer}, seal{video::media_keys(begun.keys, link::Role::Surgeon)} {}
    io::Endpoint peer;
    video::MediaSeal seal;
    video::Receiver receiver;
    TimePoint began_at{};
    TimePoint heard_at{};  ///< or the socket was made
    bool heard{};
    TimePoint reported_at{};
    std::uint64_t challenge{};  ///< to be repeated
    std::uint32_t keys{};       ///< of the wishes, heard
    Duration age{};
  };

  void open_door(TimePoint now);
  void hear(std::span<const std::byte> datagram, TimePoint arrived_at, TimePoint now);
  void show(video::ReceivedFrame&& frame, TimePoint now);
  void report(TimePoint now);
  void tell(TimePoint now);
  [[nodiscard]] video::VideoState state(TimePoint now) const;

  bool records_;
  io::MediaDoor& door_;
  Mailbox<Duration>* touch_hold_;
  CameraRecording& recording_;
  monitor::CameraFeed& feed_;
  std::function<void()> arrived_;
  ForceSeen force_;
  video::TouchHold hold_;
  std::optional<Session> session_;
  std::unique_ptr<io::DatagramSocket> socket_;
  monitor::VideoShown shown_;
  TimePoint told_at_{};
  TimePoint rate_from_{};
  std::uint64_t bytes_before_{};
  std::uint64_t frames_before_{};
};

void CameraWatching::Io::work(TimePoint now) {
  force_ = recording_.force().seen().get();
  open_door(now);
  if (session_) {
    for (const io::ReceivedDatagram& one : socket_->receive()) {
      hear(one.bytes, one.arrived_at, now);
    }
    report(now);
  }
  tell(now);
  io::wait_for_datagram(session_ ? socket_->descriptor() : -1, kWatchingRest);
}

void CameraWatching::Io::open_door(TimePoint now) {
  for (io::MediaSession begun; door_.sessions.try_dequeue(begun);) {
    session_.reset();
    if (begun.session_id == 0) continue;
    session_.emplace(std::move(begun));
    session_->began_at = session_->heard_at = now;
    bytes_before_ = frames_before_ = 0;
    rate_from_ = now;
    try {
      socket_ = std::make_unique<io::DatagramSocket>(io::DatagramSocket::connected(session_->peer));
    } catch (const std::system_error&) {
      session_.reset();  // no way there: no picture, and force says what is wrong
    }
  }
  for (io::SideDatagram stranger; door_.heard.try_dequeue(stranger);) {
    // Pictures come to the socket of the video alone.
  }
}

void CameraWatching::Io::hear(std::span<const std::byte> datagram,
                              TimePoint arrived_at,
                              TimePoint now) {
  Session& session = *session_;
  const auto opened = session.seal.open(datagram);
  if (!opened) return;
  session.heard_at = now;
  session.heard = true;
  if (auto frame = session.receiver.hear(opened->payload, arrived_at)) show(std::move(*frame), now);
  if (const std::uint64_t challenge = session.receiver.take_challenge(); challenge != 0) {
    session.challenge = challenge;
    session.reported_at = {};  // answered at once
  }
}

void CameraWatching::Io::show(video::ReceivedFrame&& frame, TimePoint now) {
  const video::CameraFrame shown{.captured_at = force_.own_line(frame.captured, now),
                                 .delivered_at = now,
                                 .key = frame.key,
                                 .jpeg = frame.jpeg,
                                 .bytes = std::move(frame.bytes)};
  session_->age = now - shown.captured_at;
  if (touch_hold_ != nullptr) hold_.add(session_->age, force_.way);
  const bool recorded = recording_.frames().offer(shown);
  const bool looked_at = feed_.frames.offer(shown);
  arrived_();
  if (!recorded || !looked_at) session_->receiver.want_key();
}

void CameraWatching::Io::report(TimePoint now) {
  Session& session = *session_;
  const bool answered = session.heard && now - session.heard_at < kSilent;
  if (now - session.reported_at < (answered ? video::StandingDelay::kStep : kKnockEvery)) return;
  session.reported_at = now;
  if (now - session.heard_at > kAnotherSocketEvery) {
    session.heard_at = now;
    session.heard = false;
    try {
      socket_->reconnect(session.peer);
    } catch (const std::system_error&) {
      // tried again
    }
  }
  const monitor::CameraWish& wish = feed_.wishes.get();
  if (std::exchange(session.keys, wish.keys) != wish.keys) session.receiver.want_key();
  session.receiver.set_watched(wish.watched || records_);
  video::Report report = session.receiver.report(force_.telegrams);
  report.echo = session.challenge;
  const auto datagram = session.seal.seal(video::write(report));
  const io::OutgoingDatagram outgoing{.bytes = datagram, .tos = io::kAssuredForwarding};
  (void)socket_->send(std::span{&outgoing, 1}, nullptr);
}

video::VideoState CameraWatching::Io::state(TimePoint now) const {
  const bool silent = !session_ || !session_->heard || now - session_->heard_at > kSilent;
  return silent ? video::VideoState::Silent : session_->receiver.peer_state();
}

void CameraWatching::Io::tell(TimePoint now) {
  if (now - told_at_ < kTellEvery) return;
  told_at_ = now;
  shown_.at = now;
  shown_.state = state(now);
  shown_.standing = force_.telegrams.standing;
  if (session_) {
    const video::ReceiverCounts& counts = session_->receiver.counts();
    shown_.age = session_->age;
    shown_.delivered = counts.delivered;
    shown_.repaired = counts.repaired;
    shown_.not_shown = counts.undecodable + counts.incomplete;
    if (now - rate_from_ >= kRateSpan) {
      const double span = seconds(now - std::exchange(rate_from_, now));
      const auto bytes = counts.bytes - std::exchange(bytes_before_, counts.bytes);
      const auto frames = counts.delivered - std::exchange(frames_before_, counts.delivered);
      shown_.kbps = 8e-3 * static_cast<double>(bytes) / span;
      shown_.fps = static_cast<double>(frames) / span;
    }
  }
  if (touch_hold_ != nullptr) {
    shown_.touch_held = hold_.wanted(now);
    touch_hold_->put(shown_.touch_held);
  }
  feed_.shown.put(shown_);
}

CameraWatching::CameraWatching(bool records,
                               io::MediaDoor& door,
                               Mailbox<Duration>* touch_hold,
                               CameraRecording& recording,
                               monitor::CameraFeed& feed,
                               std::function<void()> arrived)
    : io_{std::make_unique<Io>(records, door, touch_hold, recording, feed, std::move(arrived))},
      loop_{std::make_unique<io::BackgroundLoop>(
          "palp-video", Duration{0}, [io = io_.get()](TimePoint now) { io->work(now); })} {}

CameraWatching::~CameraWatching() = default;

void CameraWatching::stop() { loop_.reset(); }

void CameraWatching::tell_news(StatusLine& line) {
  const auto failure = loop_ ? loop_->failure() : std::nullopt;
  if (!failure || std::exchange(told_, true)) return;
  line.warn("the thread that looks through the camera has ended: " + *failure +
            "; the session goes on without pictures");
}

}  // namespace palp::site_program
