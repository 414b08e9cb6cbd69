#include "netem/model/channel.h"

#include <algorithm>
#include <cstring>

namespace palp::netem {
namespace {

/// Places for what is due beside what is on its way: a host that polls once in a while collects
/// at most link::kDatagramsPerTickMax at a time.
constexpr std::size_t kDueMax = 4 * link::kDatagramsPerTickMax;

}  // namespace

Channel::Channel(const Impairment& impairment,
                 std::uint64_t seed,
                 Direction direction,
                 std::size_t in_flight_max,
                 TimePoint start)
    : Channel{PathPlan{.impairment = impairment},
              seed,
              direction,
              in_flight_max,
              start,
              link::kDatagramSizeMax} {}

Channel::Channel(const PathPlan& plan,
                 std::uint64_t seed,
                 Direction direction,
                 std::size_t in_flight_max,
                 TimePoint start,
                 std::size_t datagram_max)
    : path_{plan, seed, direction, in_flight_max, kDueMax, start},
      datagram_max_{datagram_max},
      bytes_{std::make_unique_for_overwrite<std::byte[]>(path_.places() * datagram_max)} {}

std::span<const Decision> Channel::push(std::span<const std::byte> datagram,
                                        TimePoint now,
                                        std::uint8_t tos) noexcept {
  const std::size_t room = datagram.size() > datagram_max_ ? 0 : path_.places();
  const std::span<const Decision> decisions =
      path_.push({.at = now, .length = datagram.size(), .room = room, .tos = tos});
  ++counters_.pushed;
  counters_.copies += decisions.size() - 1;
  for (const Decision& decision : decisions) {
    count(decision);
    if (decision.verdict != Verdict::Delivered) continue;
    std::byte* const place = bytes_.get() + decision.place * datagram_max_;
    if (decision.length > 0) std::memcpy(place, datagram.data(), decision.length);
    if (decision.flipped_bit < 0) continue;
    const std::size_t bit = static_cast<std::size_t>(decision.flipped_bit) - 8 * kFrameHeaders;
    if (bit / 8 < decision.length) place[bit / 8] ^= std::byte{1} << (bit % 8);
  }
  return decisions;
}

std::optional<Channel::InPlace> Channel::pop_in_place(TimePoint now) noexcept {
  const auto decision = path_.pop(now);
  if (!decision) return std::nullopt;
  ++counters_.popped;
  achieved_.record(decision->released_at - decision->arrived_at);
  if (decision->copy == 0) {
    if (decision->index < index_next_) ++counters_.reordered;
    index_next_ = std::max(index_next_, decision->index + 1);
  }
  return InPlace{*decision, {bytes_.get() + decision->place * datagram_max_, decision->length}};
}

std::optional<Released> Channel::pop(std::span<std::byte> out, TimePoint now) noexcept {
  const auto popped = pop_in_place(now);
  if (!popped) return std::nullopt;
  const Decision& decision = popped->decision;
  const std::size_t length = std::min(popped->bytes.size(), out.size());
  if (length > 0) std::memcpy(out.data(), popped->bytes.data(), length);
  return Released{.size = popped->bytes.size(),
                  .arrived_at = decision.arrived_at,
                  .released_at = decision.released_at,
                  .index = decision.index,
                  .duplicate = decision.copy > 0,
                  .decision = decision};
}

void Channel::count(const Decision& decision) noexcept {
  switch (decision.verdict) {
    case Verdict::Delivered:
      counters_.floored += decision.floored ? 1 : 0;
      counters_.corrupted += decision.flipped_bit >= 0 ? 1 : 0;
      intended_.record(decision.intended);
      break;
    case Verdict::Lost:
      ++counters_.lost;
      break;
    case Verdict::HeaderHit:
      ++counters_.header_hit;
      break;
    case Verdict::OverLimit:
      ++counters_.over_limit;
      break;
    case Verdict::Blackout:
      ++counters_.blackout;
      break;
  }
}

}  // namespace palp::netem
