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

/// How long a mark is made anew for; it outlasts each round trip that a session lives with.
constexpr Duration kSlot = std::chrono::seconds{4};

std::int64_t slot_of(TimePoint now) { return now.time_since_epoch() / kSlot; }

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
  surveys_left_ = kSurveys;
}

const Roaming::Candidate* Roaming::find(const Endpoint& address) const {
  const auto found = std::ranges::find(candidates_, address, &Candidate::address);
  return found == candidates_.end() ? nullptr : &*found;
}

/// Whoever comes under ever new addresses takes the places of others, and others his: each telegram
/// has the same chance. Only an address that answered keeps its place.
Roaming::Candidate& Roaming::place_of(const Endpoint& address, TimePoint now) {
  const auto known = std::ranges::find(candidates_, address, &Candidate::address);
  if (known != candidates_.end() && now - known->heard_at <= kPause) return *known;
  auto place = known;
  if (place == candidates_.end()) {
    place = std::ranges::find_if(candidates_, [now](const Candidate& one) {
      return !one.address.valid() || now - one.heard_at > kPause;
    });
  }
  if (place == candidates_.end()) {
    const auto first = static_cast<std::size_t>(draw_entropy() % kCandidates);
    for (std::size_t i = 0; i < kCandidates; ++i) {
      place = candidates_.begin() + static_cast<std::ptrdiff_t>((first + i) % kCandidates);
      if (!place->answered_at) break;
    }
  }
  *place = Candidate{};
  place->address = address;
  return *place;
}

PathMessage::Nonce Roaming::mark(const Endpoint& address, std::int64_t slot) const {
  const AddressCookie::Bytes cookie = cookie_.make(address, {}, TimePoint{slot * kSlot});
  PathMessage::Nonce nonce{};
  std::ranges::copy(std::span{cookie}.last(nonce.size()), nonce.begin());
  return nonce;
}

PathQuestion Roaming::question_to(const Endpoint& address, TimePoint now) const {
  return {{PathMessage::Kind::Question, mark(address, slot_of(now)), address.bytes()}, address};
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

void Roaming::note(std::uint64_t number, const Endpoint& from, std::size_t size, TimePoint now) {
  newest_ = std::max(newest_.value_or(0), number);
  Candidate& one = place_of(from, now);
  one.newest = number;
  one.received += size;
  one.heard_at = now;
}

bool Roaming::came_back(const Candidate& candidate, TimePoint now) const {
  return candidate.address == former_ && moved_at_ && now - *moved_at_ >= kPause;
}

std::optional<PathQuestion> Roaming::survey(TimePoint now) {
  if (surveys_left_ == 0 || now < survey_at_) return std::nullopt;
  --surveys_left_;
  survey_at_ = now + kPause;
  return question_to(peer_, now);
}

bool Roaming::may_ask(const Candidate& one, const Straight& straight, TimePoint now) const {
  if (!one.address.valid() || now - one.heard_at > kPause) return false;
  if (one.asked_at && now - *one.asked_at < kPause) return false;
  // Where the present address delivers, nobody has to be asked anything.
  if (now - straight.heard_at < Detour::kSilence && !came_back(one, now)) return false;
  return one.sent + kQuestionSize <= kUnprovenShare * one.received;
}

std::optional<PathQuestion> Roaming::ask(const Straight& straight, TimePoint now) {
  if (!peer_.valid()) return std::nullopt;
  if (auto question = survey(now)) return question;
  if (questions_paid_until_ > now + (kQuestionsAtOnce - 1) * kQuestionPause) return std::nullopt;
  const auto open = [&](const Candidate& one) { return may_ask(one, straight, now); };
  const auto count = static_cast<std::uint64_t>(std::ranges::count_if(candidates_, open));
  if (count == 0) return std::nullopt;
  auto one = std::ranges::find_if(candidates_, open);
  for (std::uint64_t lot = draw_entropy() % count; lot > 0; --lot) {
    one = std::find_if(std::next(one), candidates_.end(), open);
  }
  questions_paid_until_ = std::max(questions_paid_until_, now) + kQuestionPause;
  one->asked_at = now;
  one->sent += kQuestionSize;
  return question_to(one->address, now);
}

bool Roaming::answer(const PathMessage& message, const Endpoint& from, TimePoint now) {
  if (message.kind != PathMessage::Kind::Answer || message.asked != from.bytes()) return false;
  const std::int64_t slot = slot_of(now);
  if (message.nonce != mark(from, slot) && message.nonce != mark(from, slot - 1)) return false;
  if (from == peer_) {
    surveys_left_ = 0;
    return true;
  }
  Candidate& one = place_of(from, now);
  one.heard_at = one.answered_at.emplace(now);
  return true;
}

std::optional<Endpoint> Roaming::move(const Straight& straight, TimePoint now) {
  if (moved_at_ && now - *moved_at_ < kPause) return std::nullopt;
  const bool silent = now - straight.heard_at >= kSilence;
  for (const Candidate& one : candidates_) {
    if (!one.answered_at || now - *one.answered_at > kAnswerLife) continue;
    const bool back = came_back(one, now);
    if (now - one.heard_at > kAlive || !(silent || back)) continue;
    // Whoever was followed in a gap has no claim to be followed back.
    former_ = std::exchange(peer_, one.address);
    if (back) former_ = {};
    moved_at_ = now;
    candidates_ = {};
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
