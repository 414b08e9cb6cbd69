#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/link/transport.h"

/// Two directions of a datagram pipe in virtual time, with a script for what happens to each.
namespace palp::link {

using Bytes = std::vector<std::byte>;

/// One datagram on its way out: after `delay`, with these bytes.
struct Release {
  Duration delay{};
  Bytes bytes;
};

/// What becomes of the datagram with this index: nothing, one or several releases.
using PacketOutcome = std::function<std::vector<Release>(std::uint64_t index, const Bytes& bytes)>;

inline PacketOutcome after(Duration delay) {
  return [delay](std::uint64_t, const Bytes& bytes) {
    return std::vector<Release>{Release{delay, bytes}};
  };
}

/// Loses the datagrams with these indices, delays the others.
inline PacketOutcome losing(std::vector<std::uint64_t> lost, Duration delay = Duration{0}) {
  return [lost = std::move(lost), delay](std::uint64_t index, const Bytes& bytes) {
    const bool gone = std::find(lost.begin(), lost.end(), index) != lost.end();
    return gone ? std::vector<Release>{} : std::vector<Release>{{delay, bytes}};
  };
}

inline const PacketOutcome kCut = [](std::uint64_t, const Bytes&) {
  return std::vector<Release>{};
};

/// One direction.
class Lane {
 public:
  PacketOutcome outcome{after(Duration{0})};

  void push(std::span<const std::byte> datagram, TimePoint now) {
    for (Release& release : outcome(pushed_++, Bytes{datagram.begin(), datagram.end()})) {
      waiting_.emplace(now + release.delay, std::move(release.bytes));
    }
  }
  std::optional<std::pair<TimePoint, Bytes>> pop(TimePoint now) {
    if (waiting_.empty() || waiting_.begin()->first > now) return std::nullopt;
    auto first = waiting_.extract(waiting_.begin());
    ++popped_;
    return std::pair{first.key(), std::move(first.mapped())};
  }
  [[nodiscard]] std::uint64_t pushed() const { return pushed_; }
  [[nodiscard]] std::uint64_t popped() const { return popped_; }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }

 private:
  std::multimap<TimePoint, Bytes> waiting_;
  std::uint64_t pushed_{};
  std::uint64_t popped_{};
};

/// Of a TestPipe, which outlives it.
class LaneEnd final : public Transport {
 public:
  LaneEnd(Lane& out, Lane& in) : out_{out}, in_{in} {}
  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override {
    out_.push(datagram, now);
    return true;
  }
  std::optional<Datagram> receive(std::span<std::byte, kDatagramSizeMax> buffer,
                                  TimePoint now) noexcept override {
    auto next = in_.pop(now);
    if (!next) return std::nullopt;
    const std::size_t copied = std::min(buffer.size(), next->second.size());
    std::copy_n(next->second.begin(), copied, buffer.begin());
    return Datagram{next->second.size(), next->first};
  }

 private:
  Lane& out_;
  Lane& in_;
};

/// Up: surgeon to patient. Outlives its ends.
struct TestPipe {
  std::unique_ptr<Lane> up{std::make_unique<Lane>()};
  std::unique_ptr<Lane> down{std::make_unique<Lane>()};

  [[nodiscard]] std::unique_ptr<Transport> surgeon_end() const {
    return std::make_unique<LaneEnd>(*up, *down);
  }
  [[nodiscard]] std::unique_ptr<Transport> patient_end() const {
    return std::make_unique<LaneEnd>(*down, *up);
  }
};

}  // namespace palp::link
