#include "tests/lab/run/hostile_end.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/core/random.h"
#include "common/link/replay_window.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kForgeryStream = 0x666f726765;
constexpr std::size_t kFloodEvery = 1000;                         ///< [ticks]
constexpr std::size_t kFlood = link::kDatagramsPerTickMax + 50;   ///< [datagrams]
constexpr std::size_t kTooLong = link::kDatagramSizeMax + 100;    ///< [bytes]
constexpr std::size_t kKept = link::ReplayWindow::kSize * 3 / 2;  ///< [datagrams]
constexpr std::byte kAhead{3};                                    ///< numbers
constexpr std::size_t kConnectionAt = 4;                          ///< [bytes], in the header
constexpr std::size_t kNumberEndsAt = link::kHeaderSize - 1;      ///< [bytes]

std::uint64_t checksum(std::uint64_t number, std::span<const std::byte> bytes) noexcept {
  std::uint64_t sum = random_bits(number, bytes.size(), 0);
  for (const std::byte byte : bytes)
    sum = random_bits(sum, std::to_integer<std::uint64_t>(byte), 0);
  return sum;
}

std::byte byte_of(std::uint64_t word, std::size_t at) noexcept {
  return static_cast<std::byte>(word >> (8U * at) & 0xFFU);
}

}  // namespace

struct HostileEnd::Memory {
  struct Kept {
    std::size_t size{};
    std::array<std::byte, link::kDatagramSizeMax> bytes{};
  };
  std::vector<Kept> ring{std::vector<Kept>(kKept)};
  std::uint64_t count{};

  void keep(std::span<const std::byte> datagram) noexcept {
    Kept& slot = ring[count++ % kKept];
    slot.size = datagram.size();
    std::copy(datagram.begin(), datagram.end(), slot.bytes.begin());
  }
  [[nodiscard]] std::span<const std::byte> newest() const noexcept {
    const Kept& slot = ring[(count + kKept - 1) % kKept];
    return std::span{slot.bytes}.first(slot.size);
  }
  /// Empty where nothing is that old yet.
  [[nodiscard]] std::span<const std::byte> oldest() const noexcept {
    const Kept& slot = ring[count % kKept];
    return std::span{slot.bytes}.first(slot.size);
  }
};

HostileEnd::HostileEnd(std::unique_ptr<link::Transport> end, std::uint64_t seed)
    : end_{std::move(end)}, memory_{std::make_unique<Memory>()}, seed_{seed} {}

HostileEnd::~HostileEnd() = default;

bool HostileEnd::send(std::span<const std::byte> datagram, TimePoint now) noexcept {
  return end_->send(datagram, now);
}

std::uint64_t HostileEnd::draw() noexcept { return random_bits(seed_, kForgeryStream, draws_++); }

void HostileEnd::fill(std::span<std::byte> bytes) noexcept {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i % 8 == 0) word = draw();
    bytes[i] = byte_of(word, i % 8);
  }
}

void HostileEnd::plan(TimePoint now) noexcept {
  if (now == planned_for_) return;
  planned_for_ = now;
  waiting_ = ++ticks_ % kFloodEvery == 0 ? kFlood : draw() % 3;
}

std::size_t HostileEnd::forge(Forgery forgery, std::span<std::byte> buffer) noexcept {
  if (forgery == Forgery::Noise) {
    const std::size_t size = draw() % (buffer.size() + 1);
    fill(buffer.first(size));
    return size;
  }
  if (forgery == Forgery::TooLong) {
    fill(buffer);
    return kTooLong;
  }
  const auto source = forgery == Forgery::Ancient ? memory_->oldest() : memory_->newest();
  std::copy(source.begin(), source.end(), buffer.begin());
  if (source.size() < link::kHeaderSize) return 0;
  switch (forgery) {
    case Forgery::CutOff:
      return source.size() / 2;
    case Forgery::Garbage:
      // Without a carry into the next byte this is a number not sent yet.
      buffer[kNumberEndsAt] |= kAhead;
      fill(buffer.first(source.size()).subspan(link::kHeaderSize));
      break;
    case Forgery::WrongConnection:
      buffer[kConnectionAt] ^= std::byte{0x5A};
      break;
    case Forgery::Control:
      buffer[0] |= static_cast<std::byte>(link::PacketType::Control);
      break;
    case Forgery::Repeated:
    case Forgery::Ancient:
    case Forgery::Noise:
    case Forgery::TooLong:
      break;
  }
  return source.size();
}

std::optional<link::Datagram> HostileEnd::receive(
    std::span<std::byte, link::kDatagramSizeMax> buffer, TimePoint now) noexcept {
  plan(now);
  while (waiting_ > 0) {
    --waiting_;
    const auto forgery = static_cast<Forgery>(draw() % kForgeryCount);
    const std::size_t size = forge(forgery, buffer);
    if (size > 0) return link::Datagram{size, now};
  }
  const auto datagram = end_->receive(buffer, now);
  if (datagram) memory_->keep(std::span{buffer}.first(datagram->size));
  return datagram;
}

std::size_t TaggedProtection::seal(const link::Header& header,
                                   std::span<const std::byte> plain,
                                   std::span<std::byte> out) noexcept {
  if (plain.size() + kTagSize > work_.size()) return 0;
  std::copy(plain.begin(), plain.end(), work_.begin());
  const std::uint64_t tag = checksum(header.number, plain);
  for (std::size_t i = 0; i < kTagSize; ++i) work_[plain.size() + i] = byte_of(tag, i);
  return plain_.seal(header, std::span{work_}.first(plain.size() + kTagSize), out);
}

tl::expected<std::size_t, link::Rejection> TaggedProtection::open(
    const link::Header& header,
    std::span<const std::byte> datagram,
    std::span<std::byte> plain) noexcept {
  const auto size = plain_.open(header, datagram, plain);
  if (!size) return tl::unexpected(link::Rejection::Malformed);
  if (*size < kTagSize) return tl::unexpected(link::Rejection::Malformed);
  const std::uint64_t tag = checksum(header.number, plain.first(*size - kTagSize));
  for (std::size_t i = 0; i < kTagSize; ++i) {
    if (plain[*size - kTagSize + i] != byte_of(tag, i)) {
      return tl::unexpected(link::Rejection::Forged);
    }
  }
  return *size - kTagSize;
}

}  // namespace palp::lab
