#pragma once

#include <cstdint>
#include <span>

#include "common/message/link_health.h"
#include "common/message/telegram.h"

/// What a node hears of the other site.
namespace palp::link {

enum class Role : std::uint8_t { Surgeon, Patient };

/// Sorted by number: fresh, late and repaired samples, each once. Valid until the next receive().
struct Arrivals {
  std::span<const Incoming> samples;
  SiteReport peer;
  bool peer_heard{};         ///< something was accepted in this session; else `peer` says nothing
  std::uint32_t accepted{};  ///< telegrams newer than all before, in this call
};

}  // namespace palp::link
