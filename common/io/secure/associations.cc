#include "common/io/secure/associations.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "common/link/header.h"
#include "common/link/transport.h"

namespace palp::io {
namespace {

using link::Role;
using State = DtlsHandshake::State;

/// Of an attempt, and how long a peer may ask for a lost last flight.
constexpr Duration kAttemptLife = std::chrono::seconds{15};
constexpr Duration kCallPause = std::chrono::seconds{1};

}  // namespace

Associations::Associations(const Credentials& credentials) : credentials_{credentials} {
  if (credentials.role() == Role::Patient) listener_.emplace(credentials);
}

void Associations::begin(Attempt attempt, TimePoint now) {
  if (attempts_.size() >= kAttemptsMax) make_room();
  attempts_.push_back(std::move(attempt));
  collect(attempts_.back(), now);
}

/// The oldest of the host that has begun most without finishing: whoever does so loses its own.
void Associations::make_room() {
  attempts_.erase(std::ranges::max_element(attempts_, {}, [this](const Attempt& one) {
    return admission_.debt(one.peer);
  }));  // the first of equals
}

void Associations::call(const Endpoint& peer, TimePoint now) {
  const bool running = std::ranges::any_of(
      attempts_, [](const Attempt& one) { return one.handshake.state() == State::Running; });
  if (running || (called_at_ && now - *called_at_ < kCallPause)) return;
  called_at_ = now;
  begin({.peer = peer, .random = {}, .handshake = DtlsHandshake{credentials_}, .began_at = now},
        now);
}

void Associations::hear(std::span<const std::byte> datagram, const Endpoint& from, TimePoint now) {
  const std::optional<ClientRandom> random = client_random(datagram);
  // The newest of this address; a ClientHello belongs to it only if it repeats the first one.
  const auto mine = std::find_if(attempts_.rbegin(), attempts_.rend(), [&](const Attempt& one) {
    return one.peer == from && (!random || one.random == random);
  });
  if (mine != attempts_.rend()) {
    mine->handshake.hear(datagram);
    collect(*mine, now);
    return;
  }
  if (!listener_ || !random) return;
  // Its caller repeats it, by then perhaps there is room.
  if (shows_cookie(datagram) && !admission_.open_to(from, now)) return;
  DtlsListener::Answer answer = listener_->hear(datagram, from, now);
  for (DtlsDatagram& one : answer.datagrams) letters_.push_back({from, std::move(one)});
  if (!answer.handshake) return;
  admission_.note(from, now);
  begin(
      {.peer = from, .random = random, .handshake = std::move(*answer.handshake), .began_at = now},
      now);
}

void Associations::tick(TimePoint now) {
  for (Attempt& attempt : attempts_) {
    attempt.handshake.tick();
    collect(attempt, now);
  }
  std::erase_if(attempts_, [now](const Attempt& one) {
    return one.handshake.state() == State::Failed || now - one.began_at > kAttemptLife;
  });
}

/// What has come of an attempt since the last look.
void Associations::collect(Attempt& attempt, TimePoint now) {
  for (DtlsDatagram& one : attempt.handshake.take_datagrams()) {
    letters_.push_back({attempt.peer, std::move(one)});
  }
  if (attempt.handshake.state() == State::Failed && !std::exchange(attempt.told, true)) {
    const DtlsFailure& failure = attempt.handshake.failure();
    failure_ = {"the handshake with " + attempt.peer.to_string() + " failed: " + failure.sentence,
                failure.hopeless,
                failure.silent};
  }
  std::optional<DtlsResult> result = attempt.handshake.take_result();
  if (!result) return;
  admission_.finished(attempt.peer);
  Association made;
  made.id = ++made_;
  made.peer = attempt.peer;
  made.control = std::make_unique<link::AeadProtection>(result->keys.control);
  made.proof = std::move(*result);
  made.heard_at = now;
  if (kept_.size() >= kKeptMax) {  // the one a session lives on is spared
    const auto idle = std::ranges::find_if(kept_, [](const Association& one) { return !one.used; });
    kept_.erase(idle == kept_.end() ? kept_.begin() : idle);
  }
  kept_.push_back(std::move(made));
  newly_made_.push_back(made_);
}

Association* Associations::sender_of(std::span<const std::byte> datagram, link::Header& header) {
  for (Association& one : kept_) {
    const auto read = one.control->read_header(datagram);
    if (!read || read->connection != one.proof.keys.receive_connection) continue;
    header = *read;
    return &one;
  }
  return nullptr;
}

/// Whoever copies words and is faster than their sender must not use up their numbers: those of
/// control count from the peer's address only. The answer to a question about an address comes from
/// there, so it may come from anywhere; it is good for nothing but what its nonce was drawn for.
std::optional<Associations::Opened> Associations::open(std::span<const std::byte> datagram,
                                                       const Endpoint& from,
                                                       TimePoint now) {
  link::Header header;
  Association* found = sender_of(datagram, header);
  if (found == nullptr) return std::nullopt;
  const bool answer = credentials_.role() == Role::Patient && header.type == link::PacketType::Path;
  const bool is_new = found->received.judge(header.number) == link::ReplayWindow::Verdict::New;
  if (!answer && (!is_new || !(from == found->peer))) return std::nullopt;
  std::array<std::byte, link::kDatagramSizeMax> plain{};
  const auto size = found->control->open(header, datagram, plain);
  if (!size) return std::nullopt;
  if (!answer) found->received.mark(header.number);
  found->heard = true;
  found->heard_at = now;
  Opened opened{.association = found,
                .datagram = std::vector<std::byte>(link::kHeaderSize + *size)};
  link::PlainProtection frame;
  frame.seal(header, std::span{plain}.first(*size), opened.datagram);
  return opened;
}

void Associations::send(Association& by, std::span<const std::byte> plain, const Endpoint& to) {
  const std::optional<link::Header> header = link::parse_header(plain);
  if (!header) return;
  Letter letter{to, std::vector<std::byte>(plain.size() + link::AeadProtection::kTagSize)};
  const std::size_t size = by.control->seal({.type = header->type,
                                             .key = 0,
                                             .length = 0,
                                             .connection = by.proof.keys.send_connection,
                                             .number = by.next_number++},
                                            plain.subspan(link::kHeaderSize),
                                            letter.bytes);
  if (size != 0) letters_.push_back(std::move(letter));
}

Association* Associations::newest() noexcept { return kept_.empty() ? nullptr : &kept_.back(); }

Association* Associations::find(std::uint64_t id) noexcept {
  const auto found = std::ranges::find(kept_, id, &Association::id);
  return found == kept_.end() ? nullptr : &*found;
}

void Associations::keep_only(std::uint64_t one, std::uint64_t other) {
  std::erase_if(kept_, [=](const Association& it) { return it.id != one && it.id != other; });
}

std::vector<Letter> Associations::take_letters() { return std::exchange(letters_, {}); }

std::vector<std::uint64_t> Associations::take_made() { return std::exchange(newly_made_, {}); }

std::optional<DtlsFailure> Associations::take_failure() { return std::exchange(failure_, {}); }

}  // namespace palp::io
