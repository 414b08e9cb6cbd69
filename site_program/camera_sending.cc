#include "site_program/camera_sending.h"

#include <algorithm>
#include <exception>
#include <utility>
#include <variant>

#include "common/io/net/media_wait.h"
#include "common/io/process/entropy.h"
#include "common/io/realtime/steady_clock.h"
#include "video/encoders.h"

namespace palp::site_program {
namespace {

using std::chrono::milliseconds;
using video::VideoState;

constexpr Duration kSendingRest = milliseconds{5};
constexpr Duration kWordEvery = milliseconds{500};
/// Of io, which may have been refused a socket.
constexpr Duration kAskAgain = std::chrono::seconds{1};
/// Frames are taken up again where the thread stood still for longer.
constexpr Duration kLateMax = milliseconds{100};

}  // namespace

/// All that the thread owns.
class CameraSending::Io {
 public:
  Io(const CameraSendingConfig& config,
     video::Camera& camera,
     io::MediaDoor& door,
     CameraRecording& recording)
      : config_{config}, camera_{camera}, door_{door}, recording_{recording} {}

  void work(TimePoint now);
  [[nodiscard]] std::unique_ptr<video::Encoder> make_encoder() const;

 private:
  struct Session {
    Session(io::MediaSession&& begun, std::unique_ptr<video::Encoder> made, double max_kbps)
        : id{begun.session_id},
          seal{video::media_keys(begun.keys, link::Role::Patient)},
          encoder{std::move(made)},
          proof{io::draw_entropy} {
      if (encoder) sender.emplace(video::RateConfig{.max_kbps = max_kbps}, *encoder);
    }
    std::uint64_t id{};
    video::MediaSeal seal;
    std::unique_ptr<video::Encoder> encoder;  ///< null: none can be had
    std::optional<video::Sender> sender;      ///< beside it
    AddressProof proof;
    bool unwatched{};
    bool camera_sees{true};
    TimePoint shot_at{};    ///< the last picture was due
    TimePoint spoken_at{};  ///< a fragment or a word left
  };

  void open_door(TimePoint now);
  void hear(std::span<const std::byte> datagram, const io::Endpoint& from, TimePoint now);
  void shoot(TimePoint now);
  void send(TimePoint now);
  void say_why_not(TimePoint now);
  [[nodiscard]] TimePoint next_at(TimePoint now) const;

  CameraSendingConfig config_;
  video::Camera& camera_;
  io::MediaDoor& door_;
  CameraRecording& recording_;
  ForceSeen force_;
  std::optional<Session> session_;
  std::unique_ptr<io::DatagramSocket> way_;  ///< to the proven address; null: none yet
  io::Endpoint way_to_;                      ///< asked for, or had
  TimePoint way_asked_at_{};
};

std::unique_ptr<video::Encoder> CameraSending::Io::make_encoder() const {
  try {
    std::unique_ptr<video::Encoder> encoder;
    if (!config_.jpeg) encoder = video::make_h264_encoder(camera_.width(), camera_.height());
    if (!encoder) encoder = video::make_jpeg_encoder(camera_.width(), camera_.height());
    return encoder;
  } catch (const std::exception&) {
    return nullptr;  // said in a word
  }
}

void CameraSending::Io::work(TimePoint now) {
  force_ = recording_.force().seen().get();
  open_door(now);
  if (way_) {
    for (const io::ReceivedDatagram& one : way_->receive()) hear(one.bytes, way_to_, now);
  }
  if (session_) {
    shoot(now);
    send(io::SteadyClock{}.now());
    say_why_not(now);
  }
  const TimePoint asked = io::SteadyClock{}.now();
  io::wait_for_datagram(way_ ? way_->descriptor() : -1, next_at(asked) - asked);
}

void CameraSending::Io::open_door(TimePoint now) {
  for (io::MediaSession begun; door_.sessions.try_dequeue(begun);) {
    session_.reset();
    way_.reset();
    way_to_ = {};
    if (begun.session_id != 0) session_.emplace(std::move(begun), make_encoder(), config_.max_kbps);
  }
  for (io::SideDatagram stranger; door_.heard.try_dequeue(stranger);) {
    hear(stranger.datagram(), stranger.from, now);
  }
  for (std::unique_ptr<io::DatagramSocket> way; door_.ways.try_dequeue(way);) {
    if (session_ && session_->proof.proven().valid()) way_ = std::move(way);
  }
}

void CameraSending::Io::hear(std::span<const std::byte> datagram,
                             const io::Endpoint& from,
                             TimePoint now) {
  if (!session_) return;
  const auto opened = session_->seal.open(datagram);
  if (!opened) return;
  const auto message = video::read_media(opened->payload);
  const auto* report = message ? std::get_if<video::Report>(&*message) : nullptr;
  if (report == nullptr) return;
  // An older one may be a copy that was held back: it says nothing of where its sender is.
  if (opened->newest) {
    if (const auto challenge = session_->proof.hear(from, report->echo, now)) {
      const auto question = session_->seal.seal(video::write(video::Question{*challenge}));
      (void)door_.letters.try_emplace(question, from, now);
    }
  }
  if (!(from == session_->proof.proven())) return;
  const bool another = !(way_to_ == from);
  if ((another || (!way_ && now - way_asked_at_ > kAskAgain)) && door_.wanted.try_enqueue(from)) {
    way_.reset();
    way_to_ = from;
    way_asked_at_ = now;
  }
  session_->unwatched = report->unwatched;
  if (session_->sender) session_->sender->hear(*report, force_.round_trip, now);
}

void CameraSending::Io::shoot(TimePoint now) {
  Session& session = *session_;
  if (!way_ || !session.sender || session.id != force_.session_id) return;
  if (now < session.shot_at + video::RateControl::kFramePeriod) return;
  session.shot_at += video::RateControl::kFramePeriod;
  if (now - session.shot_at > kLateMax) session.shot_at = now;
  if (session.proof.silent(now) || !session.sender->wants_picture(now)) return;
  const video::Shot shot = camera_.shoot(now);
  session.camera_sees = shot.picture != nullptr;
  if (!session.camera_sees || shot.captured_at < force_.began_at) return;
  const auto frame = session.sender->take(
      *shot.picture, shot.captured_at - force_.began_at, io::SteadyClock{}.now());
  if (!frame) return;
  (void)recording_.frames().offer({.captured_at = shot.captured_at,
                                   .delivered_at = now,
                                   .key = frame->nature.key,
                                   .jpeg = frame->jpeg,
                                   .bytes = frame->bytes});
}

void CameraSending::Io::send(TimePoint now) {
  if (!way_ || !session_->sender) return;
  while (const auto payload = session_->sender->next(now)) {
    const auto datagram = session_->seal.seal(*payload);
    const io::OutgoingDatagram outgoing{.bytes = datagram, .tos = io::kAssuredForwarding};
    (void)way_->send(std::span{&outgoing, 1}, nullptr);
    session_->spoken_at = now;
  }
}

/// While no picture goes, the other site is told why.
void CameraSending::Io::say_why_not(TimePoint now) {
  Session& session = *session_;
  if (!way_ || session.unwatched || now - session.spoken_at < kWordEvery) return;
  VideoState state = VideoState::NoEncoder;
  if (session.sender) {
    state = session.camera_sees ? session.sender->state(now) : VideoState::NoCamera;
  }
  const auto datagram = session.seal.seal(video::write(video::Word{state}));
  (void)way_->send(datagram, std::nullopt);
  session.spoken_at = now;
}

TimePoint CameraSending::Io::next_at(TimePoint now) const {
  TimePoint next = now + kSendingRest;
  if (!session_ || !session_->sender || !way_) return next;
  next = std::min(next, session_->shot_at + video::RateControl::kFramePeriod);
  if (const auto fragment = session_->sender->next_at()) next = std::min(next, *fragment);
  return std::max(next, now);
}

CameraSending::CameraSending(const CameraSendingConfig& config,
                             video::Camera& camera,
                             io::MediaDoor& door,
                             CameraRecording& recording)
    : io_{std::make_unique<Io>(config, camera, door, recording)},
      encodes_{io_->make_encoder() != nullptr},
      loop_{std::make_unique<io::BackgroundLoop>(
          "palp-video", Duration{0}, [io = io_.get()](TimePoint now) { io->work(now); })} {}

CameraSending::~CameraSending() = default;

void CameraSending::stop() { loop_.reset(); }

void CameraSending::tell_news(StatusLine& line) {
  const auto failure = loop_ ? loop_->failure() : std::nullopt;
  if (told_ || (encodes_ && !failure)) return;
  told_ = true;
  line.warn(failure ? "the camera's thread has ended: " + *failure +
                          "; the session goes on without pictures"
                    : "nobody sees the camera's pictures: this build has no encoder for them");
}

}  // namespace palp::site_program
