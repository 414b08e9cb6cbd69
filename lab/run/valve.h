#pragma once

#include <memory>
#include <utility>

#include "common/link/transport.h"

namespace palp::lab {

/// An end of a path that can be shut: nothing leaves while it is, what is on its way still arrives.
/// Thread: the lab's. Reads `shut`, which outlives it.
class Valve final : public link::Transport {
 public:
  Valve(std::unique_ptr<link::Transport> end, const bool& shut) noexcept
      : end_{std::move(end)}, shut_{shut} {}
  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override {
    return shut_ || end_->send(datagram, now);
  }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    return end_->receive(buffer, now);
  }

 private:
  std::unique_ptr<link::Transport> end_;
  const bool& shut_;
};

}  // namespace palp::lab
