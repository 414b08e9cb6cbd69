#include "common/link/session.h"

#include <algorithm>
#include <utility>

#include "common/core/random.h"
#include "common/link/packet_protection.h"

namespace palp::link {
namespace {

constexpr Duration kRefusalPause = std::chrono::seconds{10};

enum class Stream : std::uint64_t { Id = 1, Connection, SessionId };

std::uint64_t draw(std::uint64_t seed, Stream stream, std::uint64_t index) noexcept {
  return random_bits(seed, static_cast<std::uint64_t>(stream), index);
}

/// Both ids are in it, so a new id on either side makes a new one; the top half is well mixed.
std::uint32_t connection_of(std::uint64_t own, std::uint64_t peer) noexcept {
  return static_cast<std::uint32_t>(draw(own, Stream::Connection, peer) >> 32U) | 1U;
}

std::string_view name_of(Role role) noexcept {
  return role == Role::Surgeon ? "surgeon" : "patient";
}

/// "WHAT: surgeon A, patient B", which reads alike at both sites.
std::string side_by_side(Role our_role,
                         std::string_view what,
                         const std::string& ours,
                         const std::string& theirs) {
  const bool surgeon = our_role == Role::Surgeon;
  return std::string{what} + ": surgeon " + (surgeon ? ours : theirs) + ", patient " +
         (surgeon ? theirs : ours);
}

std::string hexadecimal(std::uint64_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[15 - i] = kDigits[value >> (4 * i) & 0xFU];
  return text;
}

/// Of the devices that a Hello tells of; empty where they are sound.
std::optional<std::string> malformed_devices(const Hello& hello) {
  const bool surgeon = hello.role == Role::Surgeon;
  const DeviceFacts& devices = hello.devices;
  const std::string opening = "the " + std::string{name_of(hello.role)} + "'s hello is malformed: ";
  if (surgeon && !devices.hand) return opening + "it tells of no hand";
  if (!surgeon && !devices.stage) return opening + "it tells of no stage";
  if (!surgeon && !devices.sensor) return opening + "it tells of no force sensor";
  if (const auto flaw = flaw_of(devices)) return opening + *flaw;
  return std::nullopt;
}

}  // namespace

Session::Session(SessionConfig config, std::uint64_t entropy)
    : config_{std::move(config)}, entropy_{entropy}, offered_{fresh_id()} {
  repeat_ = config_.repeat_first;
}

std::uint64_t Session::fresh_id() noexcept {
  std::uint64_t id = 0;
  while (id == 0) id = draw(entropy_, Stream::Id, ids_drawn_++);
  return id;
}

std::uint64_t Session::session_id_of(const Pair& pair) const noexcept {
  const bool surgeon = config_.role == Role::Surgeon;
  return draw(surgeon ? pair.own : pair.peer, Stream::SessionId, surgeon ? pair.peer : pair.own) |
         1U;
}

std::uint64_t Session::session_id() const noexcept {
  return present_ ? session_id_of(*present_) : 0;
}

bool Session::link_works() const noexcept {
  return present_ && (link_state_ == LinkState::Live || link_state_ == LinkState::Hold);
}

bool Session::ours(std::uint64_t id) const noexcept {
  return id == offered_ || (present_ && id == present_->own);
}

ControlBytes Session::framed(PacketType type, const ControlBytes& message) {
  ControlBytes datagram;
  const Header header{
      .type = type, .key = 0, .length = 0, .connection = 0, .number = next_number_++};
  datagram.size = PlainProtection{}.seal(header, message.view(), datagram.bytes);
  return datagram;
}

ControlBytes Session::hello_to(const Pair& pair) {
  return framed(
      PacketType::Control,
      encode(Hello{.protocol_version = config_.protocol_version,
                   .role = config_.role,
                   .session_id = pair.own,
                   .peer_session_id = pair.peer,
                   .connection_id = pair.peer == 0 ? 0 : connection_of(pair.own, pair.peer),
                   .settings_hash = config_.settings_hash,
                   .coupling = config_.coupling,
                   .git = config_.git,
                   .devices = config_.devices}));
}

SessionOutput Session::on_datagram(std::span<const std::byte> datagram, TimePoint now) {
  SessionOutput out;
  if (stopped_) return out;
  const auto header = parse_header(datagram);
  if (!header) {
    ++counters_.malformed;
    return out;
  }
  const auto message = datagram.subspan(kHeaderSize);
  if (header->type == PacketType::Control) {
    if (const auto hello = decode_hello(message)) {
      on_hello(*hello, now, out);
    } else {
      ++counters_.malformed;
    }
  } else if (header->type == PacketType::Close) {
    if (const auto bye = decode_bye(message)) {
      on_bye(*bye, out);
    } else {
      ++counters_.malformed;
    }
  } else {
    ++counters_.foreign;
  }
  return out;
}

std::optional<std::string> Session::mismatch(const Hello& hello) const {
  if (hello.protocol_version != config_.protocol_version) {
    return side_by_side(config_.role,
                        "the sites speak different protocol versions",
                        std::to_string(config_.protocol_version),
                        std::to_string(hello.protocol_version));
  }
  if (hello.role == config_.role) {
    return "both sites are " + std::string{name_of(config_.role)} + " sites";
  }
  if (auto text = malformed_devices(hello)) return text;
  if (hello.coupling != config_.coupling) {
    return side_by_side(
        config_.role, "the sites use different couplings", config_.coupling, hello.coupling);
  }
  if (hello.settings_hash != config_.settings_hash) {
    return side_by_side(config_.role,
                        "the settings of the coupling or the control periods differ, by hash",
                        hexadecimal(config_.settings_hash),
                        hexadecimal(hello.settings_hash));
  }
  return std::nullopt;
}

void Session::on_hello(const Hello& hello, TimePoint now, SessionOutput& out) {
  if (ours(hello.session_id)) {  // our own words, sent back
    ++counters_.foreign;
    return;
  }
  const bool expected = config_.role == Role::Patient || ours(hello.peer_session_id);
  if (!expected) {
    ++counters_.foreign;
    return;
  }
  if (const auto text = mismatch(hello)) {
    if (link_works() && config_.role == Role::Surgeon) {  // a stranger; the session goes on
      ++counters_.foreign;
      return;
    }
    refuse(hello, ByeReason::Mismatch, *text, now, out);
    return;
  }
  if (config_.role == Role::Patient) {
    answer_as_patient(hello, now, out);
  } else {
    hear_as_surgeon(hello, now, out);
  }
}

void Session::answer_as_patient(const Hello& hello, TimePoint now, SessionOutput& out) {
  if (present_ && hello.session_id == present_->peer) {
    out.datagrams.push_back(hello_to(*present_));
    return;
  }
  if (link_works()) {
    refuse(hello, ByeReason::Busy, "the patient site is busy with another surgeon site", now, out);
    return;
  }
  if (hello.peer_session_id == offered_ && hello.connection_id != 0) {
    establish(hello, out);
    out.datagrams.push_back(hello_to(*present_));
    return;
  }
  out.datagrams.push_back(hello_to({.own = offered_, .peer = hello.session_id}));
}

void Session::hear_as_surgeon(const Hello& hello, TimePoint now, SessionOutput& out) {
  if (present_ && hello.session_id == present_->peer) return;  // still there
  if (link_works() || hello.connection_id == 0) {
    ++counters_.foreign;
    return;
  }
  if (hello.peer_session_id == offered_) {
    establish(hello, out);
    out.datagrams.push_back(hello_to(*present_));
    next_hello_at_ = now + repeat_;
    return;
  }
  // The answer to a Hello of the present session comes from another process: the peer restarted.
  out.datagrams.push_back(hello_to({.own = offered_, .peer = hello.session_id}));
}

void Session::refuse(const Hello& hello,
                     ByeReason reason,
                     const std::string& text,
                     TimePoint now,
                     SessionOutput& out) {
  out.datagrams.push_back(framed(PacketType::Close,
                                 encode(Bye{.session_id = offered_,
                                            .peer_session_id = hello.session_id,
                                            .reason = reason,
                                            .text = text})));
  const bool final = reason == ByeReason::Mismatch && config_.role == Role::Surgeon;
  stopped_ = stopped_ || final;
  if (hello.session_id == last_refused_) return;  // it repeats itself; people were told
  last_refused_ = hello.session_id;
  // An id costs nothing: who sends ever new ones must not fill the log.
  if (!final && refused_at_ && now - *refused_at_ < kRefusalPause) return;
  refused_at_ = now;
  out.event = Refused{text, final};
}

void Session::establish(const Hello& hello, SessionOutput& out) {
  present_ = Pair{.own = offered_, .peer = hello.session_id};
  peer_git_ = hello.git;
  offered_ = fresh_id();
  link_state_ = LinkState::Down;
  link_has_session_ = false;
  repeat_ = config_.repeat_first;
  last_refused_ = 0;
  out.event = Established{.session_id = session_id_of(*present_),
                          .send_connection = hello.connection_id,
                          .receive_connection = connection_of(present_->own, present_->peer),
                          .peer_session_id = present_->peer,
                          .peer_git = peer_git_,
                          .peer_devices = hello.devices};
}

ControlBytes Session::greeting() {
  return hello_to(present_.value_or(Pair{.own = offered_, .peer = 0}));
}

bool Session::speaks_of_present(std::span<const std::byte> datagram) const {
  const auto header = parse_header(datagram);
  if (!present_ || !header || header->type != PacketType::Control) return false;
  const auto hello = decode_hello(datagram.subspan(kHeaderSize));
  return hello && hello->session_id == present_->peer && hello->peer_session_id == present_->own;
}

void Session::forget_session() {
  present_.reset();
  link_state_ = LinkState::Down;
  link_has_session_ = false;
}

void Session::on_bye(const Bye& bye, SessionOutput& out) {
  if (!ours(bye.peer_session_id)) {
    ++counters_.foreign;
    return;
  }
  const std::string text = bye.text.empty() ? "no reason given" : bye.text;
  if (present_ && bye.session_id == present_->peer) {
    forget_session();
    repeat_ = config_.repeat_max;  // it went on purpose
    next_hello_at_.reset();
    out.event = Closed{"the peer ended the session: " + text};
    return;
  }
  if (link_works()) {
    ++counters_.foreign;
    return;
  }
  const bool final = bye.reason == ByeReason::Mismatch && config_.role == Role::Surgeon;
  if (final) stopped_ = true;
  const bool told = last_refused_ == bye.session_id;
  last_refused_ = bye.session_id;
  if (!told || final) out.event = Refused{text, final};
}

SessionOutput Session::tick(TimePoint now, LinkState state, std::uint64_t link_session_id) {
  SessionOutput out;
  if (stopped_) return out;
  if (present_) {
    if (link_session_id == session_id_of(*present_)) {
      link_has_session_ = true;
      link_state_ = state;
    } else if (link_has_session_) {
      forget_session();
      out.event = Closed{"nothing was heard from the peer for too long"};
    }
  }
  if (config_.role == Role::Patient) return out;
  if (link_works()) {
    repeat_ = config_.repeat_first;
    next_hello_at_.reset();
    return out;
  }
  if (!next_hello_at_) {
    next_hello_at_ = now;
  }
  if (now < *next_hello_at_) return out;
  out.datagrams.push_back(hello_to(present_.value_or(Pair{.own = offered_, .peer = 0})));
  next_hello_at_ = now + repeat_;
  repeat_ = std::min(config_.repeat_max, from_seconds(seconds(repeat_) * config_.repeat_growth));
  return out;
}

SessionOutput Session::close(std::string_view text) {
  SessionOutput out;
  if (present_ && !stopped_) {
    const ControlBytes bye = encode(Bye{.session_id = present_->own,
                                        .peer_session_id = present_->peer,
                                        .reason = ByeReason::Leaving,
                                        .text = std::string{text}});
    constexpr int kRepetitions = 3;
    for (int i = 0; i < kRepetitions; ++i) {
      out.datagrams.push_back(framed(PacketType::Close, bye));
    }
  }
  forget_session();
  stopped_ = true;
  return out;
}

}  // namespace palp::link
