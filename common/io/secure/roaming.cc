#include "common/io/secure/roaming.h"

#include <algorithm>
#include <utility>

#include "common/io/process/entropy.h"
#include "common/link/aead_protection.h"

namespace palp::io {
namespace {

using std::chrono::milliseconds;

/// How far a sender may lie behind somebody who copies its telegrams.
constexpr std::uint64_t kBehindMax = 256;  // [numbers]
/// Bytes of questions to an unproven address per byte from it; to no more than three altogether,
/// because rt sends telegrams there as well.
constexpr std::size_t kUnprovenShare = 3 - Detour::kShare;
constexpr std::size_t kQuestionSize =
    link::kHeaderSize + PathMessage::kSize + link::AeadProtection::kTagSize;  // [bytes]
/// An address that delivers nothing for so long is not moved to.
constexpr Duration kAlive = milliseconds{100};
/// An answer tells of the way as it was a short while ago.
constexpr Duration kAnswerLife = std::chrono::seconds{2};
constexpr int kSurveys = 3;

PathMessage::Nonce draw_nonce() {
  const std::uint64_t bits = draw_entropy();
  PathMessage::Nonce bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::byte>(bits >> (8 * i) & 0xFFU);
  }
  return bytes;
}

}  // namespace

std::optional<PathMessage> PathMessage::parse(std::span<const std::byte> content) {
  if (content.size() != kSize) return std::nullopt;
  if (std::to_integer<unsigned>(content[0]) > static_cast<unsigned>(Kind::Answer)) {
    return std::nullopt;
  }
  PathMessage message{.kind = static_cast<Kind>(content[0])};
  std::ranges::copy(content.subspan(1, message.nonce.size()), message.nonce.begin());
  std::ranges::copy(content.last(message.asked.size()), message.asked.begin());
  return message;
}

std::vector<std::byte> PathMessage::framed(std::uint64_t number) const {
  std::array<std::byte, kSize> content{static_cast<std::byte>(kind)};
  std::ranges::copy(nonce, content.begin() + 1);
  std::ranges::copy(asked, content.end() - sizeof asked);
  std::vector<std::byte> datagram(link::kHeaderSize + content.size());
  link::PlainProtection{}.seal(
      {.type = link::PacketType::Path, .key = 0, .length = 0, .connection = 0, .number = number},
      content,
      datagram);
  return datagram;
}

void Roaming::begin(const Endpoint& peer) {
  *this = Roaming{};
  peer_ = peer;
  survey_nonce_ = draw_nonce();
  surveys_left_ = kSurveys;
}

const Roaming::Candidate* Roaming::find(const Endpoint& address) const {
  for (const Place& place : places_) {
    if (place.candidate && place.candidate->address == address) return &*place.candidate;
  }
  return nullptr;
}

bool Roaming::is_newest(std::uint64_t number, const Straight& straight) const {
  return number > std::max(straight.newest_number, newest_.value_or(0));
}

/// Only what is newer than all: an old datagram, sent again from elsewhere, must not move us. But
/// where the newest came from elsewhere already, whoever comes a little later with what came there
/// first may be the sender, and the other one somebody who copies it on its way and is faster. The
/// same holds for the address that was left.
bool Roaming::counts(std::uint64_t number, const Endpoint& from, const Straight& straight) const {
  if (from == peer_) return false;
  if (is_newest(number, straight)) return true;
  const std::uint64_t newest_here = newest_.value_or(0);
  const bool elsewhere = newest_ && newest_here >= straight.newest_number;
  if (!elsewhere && !(from == former_)) return false;
  const std::uint64_t newest = std::max(straight.newest_number, newest_here);
  const Candidate* known = find(from);
  return newest - number < kBehindMax && (known == nullptr || known->newest < number);
}

void Roaming::note(std::uint64_t number,
                   const Endpoint& from,
                   std::size_t size,
                   const Straight& straight,
                   TimePoint now) {
  const bool newest = is_newest(number, straight);
  newest_ = std::max(newest_.value_or(0), number);
  const auto known = std::ranges::find_if(
      places_, [&](const Place& one) { return one.candidate && one.candidate->address == from; });
  Place& place = known != places_.end() ? *known : places_[newest ? 0 : 1];
  if (known == places_.end()) {
    place.candidate.emplace();
    place.candidate->address = from;
    place.candidate->nonce = draw_nonce();
  }
  place.candidate->newest = number;
  place.candidate->received += size;
  place.candidate->heard_at = now;
}

bool Roaming::came_back(const Candidate& candidate, TimePoint now) const {
  return candidate.address == former_ && moved_at_ && now - *moved_at_ >= kPause;
}

std::optional<PathQuestion> Roaming::survey(TimePoint now) {
  if (surveys_left_ == 0 || now < survey_at_) return std::nullopt;
  --surveys_left_;
  survey_at_ = now + kPause;
  return PathQuestion{{PathMessage::Kind::Question, survey_nonce_, peer_.bytes()}, peer_};
}

std::optional<PathQuestion> Roaming::ask(const Straight& straight, TimePoint now) {
  if (!peer_.valid()) return std::nullopt;
  for (Place& place : places_) {
    std::optional<Candidate>& one = place.candidate;
    if (one && now - one->heard_at > kPause) one.reset();
    if (!one || (place.asked_at && now - *place.asked_at < kPause)) continue;
    // Where the present address delivers, nobody has to be asked anything.
    if (now - straight.heard_at < Detour::kSilence && !came_back(*one, now)) continue;
    if (one->sent + kQuestionSize > kUnprovenShare * one->received) continue;
    place.asked_at = now;
    one->sent += kQuestionSize;
    return PathQuestion{{PathMessage::Kind::Question, one->nonce, one->address.bytes()},
                        one->address};
  }
  return survey(now);
}

bool Roaming::answer(const PathMessage& message, const Endpoint& from, TimePoint now) {
  if (message.kind != PathMessage::Kind::Answer || message.asked != from.bytes()) return false;
  if (from == peer_ && message.nonce == survey_nonce_) {
    surveys_left_ = 0;
    return true;
  }
  for (Place& place : places_) {
    std::optional<Candidate>& one = place.candidate;
    if (!one || !(one->address == from) || one->nonce != message.nonce) continue;
    one->answered_at = now;
    return true;
  }
  return false;
}

std::optional<Endpoint> Roaming::move(const Straight& straight, TimePoint now) {
  if (moved_at_ && now - *moved_at_ < kPause) return std::nullopt;
  const bool silent = now - straight.heard_at >= kSilence;
  for (const Place& place : places_) {
    const std::optional<Candidate>& one = place.candidate;
    if (!one || !one->answered_at || now - *one->answered_at > kAnswerLife) continue;
    const bool back = came_back(*one, now);
    if (now - one->heard_at > kAlive || !(silent || back)) continue;
    // Whoever was followed in a gap has no claim to be followed back.
    former_ = std::exchange(peer_, one->address);
    if (back) former_ = {};
    moved_at_ = now;
    places_ = {};
    return peer_;
  }
  return std::nullopt;
}

std::optional<PathMessage> PathAnswers::answer(const PathMessage& question,
                                               const Endpoint& from,
                                               const Endpoint& peer) {
  if (question.kind != PathMessage::Kind::Question || !(from == peer)) return std::nullopt;
  if (own_.valid() && question.asked == own_.bytes()) {
    seen_as_ = own_;
  } else if (own_ == seen_as_) {
    return std::nullopt;  // nothing between us changes addresses: that one is not ours
  }
  return PathMessage{PathMessage::Kind::Answer, question.nonce, question.asked};
}

}  // namespace palp::io
