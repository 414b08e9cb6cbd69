#include "common/io/secure/dtls_session.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "common/io/net/detour.h"
#include "common/io/process/entropy.h"

namespace palp::io {
namespace {

using link::AeadProtection;
using link::PacketType;
using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// The old keys open that long after the new ones are in use.
constexpr Duration kChangeover = seconds{2};
/// A peer that has not answered for so long may have lost its keys.
constexpr Duration kUnanswered = milliseconds{1500};
constexpr Duration kGreetingPause = milliseconds{200};
constexpr Duration kGreetingLife = seconds{15};
constexpr Duration kQuestionPause = milliseconds{200};
constexpr int kQuestionsMax = 3;
/// How far a sender may lie behind somebody who copies its telegrams.
constexpr std::uint64_t kBehindMax = 256;  // [numbers]
/// Bytes of questions to an unproven address per byte from it; to no more than three altogether,
/// because rt sends telegrams there as well.
constexpr std::size_t kUnprovenShare = 3 - Detour::kShare;
constexpr Duration kFailurePause = seconds{10};
constexpr std::byte kQuestion{0};
constexpr std::byte kAnswer{1};
constexpr std::size_t kPathSize = 9;  // [bytes]: what it is, and eight random ones

std::array<std::byte, 8> draw_question() {
  const std::uint64_t bits = draw_entropy();
  std::array<std::byte, 8> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::byte>(bits >> (8 * i) & 0xFFU);
  }
  return bytes;
}

std::vector<std::byte> path_message(std::byte what,
                                    std::span<const std::byte> nonce,
                                    std::uint64_t number) {
  std::array<std::byte, kPathSize> content{what};
  std::ranges::copy(nonce, content.begin() + 1);
  std::vector<std::byte> datagram(link::kHeaderSize + content.size());
  link::PlainProtection{}.seal(
      {.type = PacketType::Path, .key = 0, .length = 0, .connection = 0, .number = number},
      content,
      datagram);
  return datagram;
}

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
  const std::optional<link::Header> header = link::parse_header(datagram);
  if (!header) {
    ++malformed_;
    return;
  }
  if (header->type == PacketType::Data) {
    out.detours = hear_data(datagram, from, now);
    return;
  }
  const auto opened = associations_.open(datagram, now);
  if (!opened) {
    ++foreign_;
    return;
  }
  if (header->type == PacketType::Path) {
    hear_path(*opened, from, out);
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
  candidates_ = {};
  greeted_ = 0;
  peer_ = from;
  proof_ = by.proof.peer_name;
  data_connection_ = std::get<link::Established>(*out.event).receive_connection;
  data_newest_.reset();
  out.protection = std::make_unique<AeadProtection>(data_keys(by, key_id_));
  opener_ = std::make_unique<AeadProtection>(data_keys(by, key_id_));
  associations_.keep_only(present_, 0);
}

void DtlsSession::forget() {
  present_ = 0;
  next_ = 0;
  greeted_ = 0;
  changeover_ends_at_.reset();
  candidates_ = {};
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
  for (std::optional<Candidate>& one : candidates_) {
    if (one && now >= one->next_at) ask(one, now);
  }
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
  if (Association* by = associations_.find(present_)) say(said, *by, peer_);
  forget();
  out.letters = associations_.take_letters();
  return out;
}

/// What rt did not get because it comes from elsewhere than the peer's address.
bool DtlsSession::hear_data(std::span<const std::byte> datagram,
                            const Endpoint& from,
                            TimePoint now) {
  const link::Header header = *link::parse_header(datagram);
  const bool follows = config_.session.role == Role::Patient && opener_ != nullptr &&
                       header.connection == data_connection_ && !(from == peer_);
  const auto known = std::ranges::find_if(
      candidates_, [&](const auto& one) { return one && one->address == from; });
  // Only what is newer than all: an old datagram, sent again from elsewhere, must not move us. But
  // where the newest came from elsewhere already, whoever comes a little later with what came there
  // first may be the sender, and the other one somebody who copies it on its way and is faster.
  const std::uint64_t newest_here = data_newest_.value_or(0);
  const bool newest = header.number > std::max(link_.newest_number, newest_here);
  const bool second = !newest && data_newest_ && newest_here >= link_.newest_number &&
                      newest_here - std::min(newest_here, header.number) < kBehindMax &&
                      (known == candidates_.end() || (*known)->newest < header.number);
  std::array<std::byte, link::kDatagramSizeMax> plain{};
  if (!follows || !(newest || second) || !opener_->open(datagram, plain)) {
    ++foreign_;
    return false;
  }
  data_newest_ = std::max(newest_here, header.number);
  if (known != candidates_.end()) {
    (*known)->newest = header.number;
    (*known)->received += datagram.size();
    return newest;
  }
  std::optional<Candidate>& place = candidates_[newest ? 0 : 1];
  place = Candidate{.address = from,
                    .question = draw_question(),
                    .newest = header.number,
                    .received = datagram.size()};
  ask(place, now);
  return newest;
}

void DtlsSession::ask(std::optional<Candidate>& place, TimePoint now) {
  Association* by = associations_.find(present_);
  constexpr std::size_t kSize = link::kHeaderSize + kPathSize + AeadProtection::kTagSize;
  Candidate& candidate = *place;
  if (by == nullptr || candidate.asked >= kQuestionsMax) {
    place.reset();  // its next datagram may begin anew
    return;
  }
  candidate.next_at = now + kQuestionPause;
  if (candidate.sent + kSize > kUnprovenShare * candidate.received) return;
  ++candidate.asked;
  candidate.sent += kSize;
  associations_.send(
      *by, path_message(kQuestion, candidate.question, path_number_++), candidate.address);
}

void DtlsSession::hear_path(const Associations::Opened& opened,
                            const Endpoint& from,
                            SessionEndpointOutput& out) {
  const auto content = std::span{opened.datagram}.subspan(link::kHeaderSize);
  if (content.size() != kPathSize) {
    ++malformed_;
    return;
  }
  const auto nonce = content.subspan(1);
  if (content[0] == kQuestion) {
    associations_.send(*opened.association, path_message(kAnswer, nonce, path_number_++), from);
    return;
  }
  const bool answered = std::ranges::any_of(candidates_, [&](const auto& one) {
    return one && one->address == from && std::ranges::equal(nonce, one->question);
  });
  if (content[0] != kAnswer || !answered) {
    ++foreign_;
    return;
  }
  peer_ = from;
  candidates_ = {};
  out.moved_to = from;
}

void DtlsSession::tell_failure(TimePoint now, SessionEndpointOutput& out) {
  std::optional<std::string> failure = associations_.take_failure();
  if (!failure || out.event) return;
  if (told_ == *failure && told_at_ && now - *told_at_ < kFailurePause) return;
  if (told_at_ && now - *told_at_ < seconds{1}) return;  // whoever it is: not more often
  told_ = *failure;
  told_at_ = now;
  out.event = link::Refused{std::move(*failure), false};
}

std::unique_ptr<SessionEndpoint> make_session_endpoint(const DtlsSessionConfig& config,
                                                       const Credentials* credentials) {
  if (credentials == nullptr) {
    return std::make_unique<PlainSession>(config.session, draw_entropy(), config.callee);
  }
  return std::make_unique<DtlsSession>(config, *credentials, draw_entropy());
}

}  // namespace palp::io
