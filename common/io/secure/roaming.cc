#include "common/io/secure/roaming.h"

#include <algorithm>
#include <utility>

#include "common/link/aead_protection.h"

namespace palp::io {
namespace {

using std::chrono::milliseconds;

/// How far a sender may lie behind somebody who copies its telegrams.
constexpr std::uint64_t kBehindMax = 256;  // [numbers]
constexpr std::size_t kQuestionSize =
    link::kHeaderSize + PathMessage::kSize + link::AeadProtection::kTagSize;  // [bytes]
// A question is no longer than the telegram that draws it: with what rt sends there as well, at
// most three bytes go to an unproven address for each byte from it.
static_assert(Detour::kShare == 2);
/// An address that delivers nothing for so long is not moved to.
constexpr Duration kAlive = milliseconds{100};
/// An answer tells of the way as it was a short while ago.
constexpr Duration kAnswerLife = std::chrono::seconds{2};
constexpr int kSurveys = 3;
/// An answer is known again for so long at least, and for twice as long at most: longer than any
/// round trip that a session may have.
constexpr Duration kQuestionLife = std::chrono::seconds{4};

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
  return std::max(straight.newest_number, newest_here) - number < kBehindMax;
}

std::optional<PathQuestion> Roaming::note(std::uint64_t number,
                                          const Endpoint& from,
                                          std::size_t size,
                                          const Straight& straight,
                                          TimePoint now) {
  newest_ = std::max(newest_.value_or(0), number);
  for (Answered& one : answered_) {
    if (one.address == from) one.heard_at = now;
  }
  // Where the present address delivers, nobody has to be asked anything.
  if (now - straight.heard_at < Detour::kSilence && !came_back(from, now)) return std::nullopt;
  if (size < kQuestionSize || !may_ask(from, now)) return std::nullopt;
  return question(from, now);
}

bool Roaming::came_back(const Endpoint& address, TimePoint now) const {
  return address == former_ && moved_at_ && now - *moved_at_ >= kPause;
}

/// Not too soon again. There is no limit for all addresses together: who has many would use it up.
bool Roaming::may_ask(const Endpoint& address, TimePoint now) {
  auto known = std::ranges::find(asked_, address, &Asked::address);
  if (known != asked_.end() && now - known->at < kPause) return false;
  if (known == asked_.end()) {
    known = asked_.begin() + static_cast<std::ptrdiff_t>(asked_next_);
    asked_next_ = (asked_next_ + 1) % asked_.size();
  }
  *known = {.address = address, .at = now};
  return true;
}

/// Its random bytes are those of a cookie for the address, made at the beginning of a span of time.
PathQuestion Roaming::question(const Endpoint& to, TimePoint now) const {
  PathQuestion question{{.kind = PathMessage::Kind::Question, .asked = to.bytes()}, to};
  const AddressCookie::Bytes cookie =
      cookie_.make(to, {}, now - now.time_since_epoch() % kQuestionLife);
  std::copy_n(cookie.end() - question.message.nonce.size(),
              question.message.nonce.size(),
              question.message.nonce.begin());
  return question;
}

bool Roaming::asked(const PathMessage& answer, const Endpoint& from, TimePoint now) const {
  return answer.nonce == question(from, now).message.nonce ||
         answer.nonce == question(from, now - kQuestionLife).message.nonce;
}

std::optional<PathQuestion> Roaming::survey(TimePoint now) {
  if (!peer_.valid() || surveys_left_ == 0 || now < survey_at_) return std::nullopt;
  --surveys_left_;
  survey_at_ = now + kPause;
  return question(peer_, now);
}

bool Roaming::answer(const PathMessage& message, const Endpoint& from, TimePoint now) {
  if (message.kind != PathMessage::Kind::Answer || message.asked != from.bytes()) return false;
  if (!asked(message, from, now)) return false;
  if (from == peer_) {
    surveys_left_ = 0;
    return true;
  }
  const auto known = std::ranges::find(answered_, from, &Answered::address);
  Answered& place =
      known != answered_.end() ? *known : *std::ranges::min_element(answered_, {}, &Answered::at);
  place = {.address = from, .at = now, .heard_at = now};
  return true;
}

std::optional<Endpoint> Roaming::move(const Straight& straight, TimePoint now) {
  if (moved_at_ && now - *moved_at_ < kPause) return std::nullopt;
  const bool silent = now - straight.heard_at >= kSilence;
  const Answered* best = nullptr;  // heard last: the others may have been left since
  for (const Answered& one : answered_) {
    if (!one.address.valid() || now - one.at > kAnswerLife) continue;
    if (now - one.heard_at > kAlive || !(silent || came_back(one.address, now))) continue;
    if (best == nullptr || one.heard_at > best->heard_at) best = &one;
  }
  if (best == nullptr) return std::nullopt;
  // Whoever was followed in a gap has no claim to be followed back.
  const bool back = came_back(best->address, now);
  former_ = std::exchange(peer_, best->address);
  if (back) former_ = {};
  moved_at_ = now;
  answered_ = {};
  return peer_;
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
