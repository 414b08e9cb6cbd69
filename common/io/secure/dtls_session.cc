#include "common/io/secure/dtls_session.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "common/io/process/entropy.h"

namespace palp::io {
namespace {

using link::AeadProtection;
using link::PacketType;
using link::Role;
using std::chrono::milliseconds;

/// The old keys open that long after the new ones are in use.
constexpr Duration kChangeover = std::chrono::seconds{2};
/// A peer that has not answered for so long may have lost its keys.
constexpr Duration kUnanswered = milliseconds{1500};
constexpr Duration kGreetingPause = milliseconds{200};
constexpr Duration kGreetingLife = std::chrono::seconds{15};
constexpr Duration kFailurePause = std::chrono::seconds{10};

}  // namespace

DtlsSession::DtlsSession(const DtlsSessionConfig& config,
                         const Credentials& credentials,
                         std::uint64_t entropy)
    : config_{config}, session_{config.session, entropy}, associations_{credentials} {}

link::SessionCounters DtlsSession::counters() const {
  link::SessionCounters all = session_.counters();
  all.foreign += foreign_;
  all.malformed += malformed_;
  return all;
}

link::TrafficKeys DtlsSession::data_keys(const Association& of, std::uint8_t id) const {
  link::TrafficKeys keys = of.proof.keys.data;
  keys.id = id;
  return keys;
}

SessionEndpointOutput DtlsSession::hear(std::span<const std::byte> datagram,
                                        const Endpoint& from,
                                        TimePoint now) {
  SessionEndpointOutput out;
  if (looks_like_dtls(datagram)) {
    associations_.hear(datagram, from, now);
  } else {
    hear_sealed(datagram, from, now, out);
  }
  tell_failure(now, out);
  out.letters = associations_.take_letters();
  return out;
}

void DtlsSession::hear_sealed(std::span<const std::byte> datagram,
                              const Endpoint& from,
                              TimePoint now,
                              SessionEndpointOutput& out) {
  const std::optional<link::Header> header = link::parse_clear_part(datagram);
  if (!header) {
    ++malformed_;
    return;
  }
  if (header->type == PacketType::Data) {
    out.detours = hear_data(datagram, from, now);
    return;
  }
  const auto opened = associations_.open(datagram, from, now);
  if (!opened) {
    ++foreign_;
    return;
  }
  if (header->type == PacketType::Path) {
    hear_path(*opened, from, now);
    return;
  }
  Association& by = *opened->association;
  if (by.id == greeted_) greeted_ = 0;
  if (session_.speaks_of_present(opened->datagram)) replace_keys(by, now, out);
  link::SessionOutput said = session_.on_datagram(opened->datagram, now);
  say(said, by, from);
  out.event = std::move(said.event);
  if (!out.event) return;
  if (std::holds_alternative<link::Established>(*out.event)) {
    keyed_at_ = now;
    establish(by, from, out);
  } else if (std::holds_alternative<link::Closed>(*out.event)) {
    out.protection.reset();
    forget();
  }
}

void DtlsSession::say(const link::SessionOutput& output, Association& by, const Endpoint& to) {
  for (const link::ControlBytes& datagram : output.datagrams) {
    associations_.send(by, datagram.view(), to);
  }
}

/// A session gets data keys that no other session had: its numbers start at 0 again.
void DtlsSession::establish(Association& by, const Endpoint& from, SessionEndpointOutput& out) {
  if (by.used) {
    out.event = link::Refused{"the keys of this handshake have served a session already", false};
    associations_.keep_only(present_, 0);
    return;
  }
  by.used = true;
  present_ = by.id;
  next_ = 0;
  key_id_ = 0;
  changeover_ends_at_.reset();
  greeted_ = 0;
  roaming_.begin(from);
  proof_ = by.proof.peer_name;
  fingerprint_ = by.proof.peer_fingerprint;
  data_connection_ = std::get<link::Established>(*out.event).receive_connection;
  out.protection = std::make_unique<AeadProtection>(data_keys(by, key_id_));
  opener_ = std::make_unique<AeadProtection>(data_keys(by, key_id_));
  out.media = by.proof.media;
  associations_.keep_only(present_, 0);
}

void DtlsSession::forget() {
  present_ = 0;
  next_ = 0;
  greeted_ = 0;
  changeover_ends_at_.reset();
  roaming_.end();
  opener_.reset();
  data_connection_ = 0;
  associations_.keep_only(0, 0);
}

/// The peer speaks of the present session under the keys of another handshake: those are next.
void DtlsSession::replace_keys(Association& by, TimePoint now, SessionEndpointOutput& out) {
  Association* present = associations_.find(present_);
  if (present == nullptr || by.id == present_ || by.id == next_ || by.used) return;
  if (by.proof.peer_fingerprint != present->proof.peer_fingerprint) return;
  if (next_ != 0 && changeover_ends_at_) {  // the peer is known to use those
    end_changeover(out);
    present = associations_.find(present_);
  }
  by.used = true;
  next_ = by.id;
  keyed_at_ = now;
  const bool leads = config_.session.role == Role::Surgeon;
  changeover_ends_at_.reset();
  if (leads) changeover_ends_at_ = now + kChangeover;
  const auto id = static_cast<std::uint8_t>((key_id_ + 1) % (link::kKeyMax + 1));
  const auto both = [&] {
    return std::make_unique<AeadProtection>(
        data_keys(*present, key_id_),
        data_keys(by, id),
        leads ? AeadProtection::Lead::Own : AeadProtection::Lead::Peer);
  };
  out.protection = both();
  opener_ = both();
}

void DtlsSession::end_changeover(SessionEndpointOutput& out) {
  const Association* next = associations_.find(next_);
  changeover_ends_at_.reset();
  if (next == nullptr) return;
  key_id_ = static_cast<std::uint8_t>((key_id_ + 1) % (link::kKeyMax + 1));
  present_ = std::exchange(next_, 0);
  out.protection = std::make_unique<AeadProtection>(data_keys(*next, key_id_));
  opener_ = std::make_unique<AeadProtection>(data_keys(*next, key_id_));
}

SessionEndpointOutput DtlsSession::tick(TimePoint now, const LinkGlance& link) {
  SessionEndpointOutput out;
  link_ = link;
  associations_.tick(now);
  const bool ours = session_.established() && link.session_id == session_.session_id();
  // The patient leaves the old keys some time after it has heard the new ones.
  const auto next_id = static_cast<std::uint8_t>((key_id_ + 1) % (link::kKeyMax + 1));
  if (next_ != 0 && !changeover_ends_at_ && ours && link.key == next_id) {
    changeover_ends_at_ = now + kChangeover;
  }
  if (changeover_ends_at_ && now >= *changeover_ends_at_) {
    end_changeover(out);
    associations_.keep_only(present_, greeted_);
  }
  link::SessionOutput said = session_.tick(now, link.state, link.session_id);
  out.event = std::move(said.event);
  if (out.event && std::holds_alternative<link::Closed>(*out.event)) {
    out.protection.reset();
    forget();
  }
  const std::vector<std::uint64_t> made = associations_.take_made();
  if (config_.session.role == Role::Surgeon) {
    speak_as_surgeon(said, made, now);
    greet(now);
  }
  if (config_.session.role == Role::Patient) follow(now, out);
  tell_failure(now, out);
  out.letters = associations_.take_letters();
  return out;
}

void DtlsSession::speak_as_surgeon(const link::SessionOutput& output,
                                   const std::vector<std::uint64_t>& made,
                                   TimePoint now) {
  for (const std::uint64_t one : made) {
    greeted_ = one;
    greet_next_ = now;
    greet_until_ = now + kGreetingLife;
  }
  if (present_ != 0 && next_ == 0 && greeted_ == 0 && now - keyed_at_ > config_.rekey_after) {
    associations_.call(config_.callee, now);
  }
  if (output.datagrams.empty()) return;
  Association* by = associations_.newest();
  if (by == nullptr || now - by->heard_at > kUnanswered) associations_.call(config_.callee, now);
  if (by != nullptr) say(output, *by, config_.callee);
}

/// The first word under new keys: it begins a session, or gives the present one new keys.
void DtlsSession::greet(TimePoint now) {
  if (greeted_ == 0) return;
  Association* by = associations_.find(greeted_);
  if (by == nullptr || now > greet_until_) {
    greeted_ = 0;
    return;
  }
  if (now < greet_next_) return;
  greet_next_ = now + kGreetingPause;
  associations_.send(*by, session_.greeting().view(), config_.callee);
}

SessionEndpointOutput DtlsSession::close(std::string_view why) {
  SessionEndpointOutput out;
  const link::SessionOutput said = session_.close(why);
  if (Association* by = associations_.find(present_)) say(said, *by, roaming_.peer());
  forget();
  out.letters = associations_.take_letters();
  return out;
}

Roaming::Straight DtlsSession::straight(TimePoint now) const {
  // Before rt has this session, its present address has not had a chance yet.
  const bool ours = session_.established() && link_.session_id == session_.session_id();
  return {.newest_number = link_.newest_number, .heard_at = ours ? link_.peer_heard_at : now};
}

/// What rt did not get because it comes from elsewhere than the peer's address.
bool DtlsSession::hear_data(std::span<const std::byte> datagram,
                            const Endpoint& from,
                            TimePoint now) {
  tl::expected<link::Header, link::Rejection> header = tl::unexpected(link::Rejection::Foreign);
  if (config_.session.role == Role::Patient && opener_ != nullptr) {
    header = opener_->read_header(datagram);
  }
  std::array<std::byte, link::kDatagramSizeMax> plain{};
  if (!header || header->connection != data_connection_ ||
      !roaming_.counts(header->number, from, straight(now)) ||
      !opener_->open(*header, datagram, plain)) {
    ++foreign_;
    return false;
  }
  const auto question = roaming_.note(header->number, from, datagram.size(), straight(now), now);
  Association* by = associations_.find(present_);
  if (question && by != nullptr) send_path(*by, question->message, question->to);
  return true;
}

void DtlsSession::send_path(Association& by, const PathMessage& message, const Endpoint& to) {
  associations_.send(by, message.framed(path_number_++), to);
}

/// The patient follows the surgeon.
void DtlsSession::follow(TimePoint now, SessionEndpointOutput& out) {
  Association* by = associations_.find(present_);
  if (by == nullptr) return;
  if (const auto question = roaming_.survey(now)) send_path(*by, question->message, question->to);
  out.moved_to = roaming_.move(straight(now), now);
  if (!out.moved_to) return;
  out.moved_from = roaming_.former();
  by->peer = *out.moved_to;
  if (Association* next = associations_.find(next_)) next->peer = *out.moved_to;
}

void DtlsSession::hear_path(const Associations::Opened& opened,
                            const Endpoint& from,
                            TimePoint now) {
  const auto message = PathMessage::parse(std::span{opened.datagram}.subspan(link::kHeaderSize));
  if (!message) {
    ++malformed_;
    return;
  }
  if (config_.session.role == Role::Patient) {
    if (!roaming_.answer(*message, from, now)) ++foreign_;
    return;
  }
  if (const auto answer = path_answers_.answer(*message, from, roaming_.peer())) {
    send_path(*opened.association, *answer, from);
  } else {
    ++foreign_;
  }
}

void DtlsSession::tell_failure(TimePoint now, SessionEndpointOutput& out) {
  std::optional<DtlsFailure> failure = associations_.take_failure();
  if (!failure || out.event) return;
  // A surgeon calls one patient only. In a session it has keys, and a patient waits for others.
  const bool first = config_.session.role == Role::Surgeon && present_ == 0 && proof_.empty();
  if (failure->hopeless && first) {
    out.event = link::Refused{std::move(failure->sentence), true};
    return;
  }
  if (told_ == failure->sentence && told_at_ && now - *told_at_ < kFailurePause) return;
  if (told_at_ && now - *told_at_ < std::chrono::seconds{1})
    return;  // whoever it is: not more often
  told_ = failure->sentence;
  told_at_ = now;
  out.event = link::Refused{std::move(failure->sentence), false};
  out.unanswered = failure->silent;
}

std::unique_ptr<SessionEndpoint> make_session_endpoint(const DtlsSessionConfig& config,
                                                       const Credentials* credentials) {
  if (credentials == nullptr) {
    return std::make_unique<PlainSession>(config.session, draw_entropy(), config.callee);
  }
  return std::make_unique<DtlsSession>(config, *credentials, draw_entropy());
}

}  // namespace palp::io
