#pragma once

#include "common/link/codec.h"
#include "common/message/wire_bytes.h"
#include "tests/common/message/draw.h"

/// Well formed telegrams for tests.
namespace palp::link {

inline WireTelegram some_telegram(std::uint64_t seed) {
  message::Draw draw{seed};
  WireTelegram wire;
  wire.older_count = static_cast<std::uint8_t>(draw.below(wire.older.size() + 1));
  const std::uint8_t older_count = wire.older_count;
  message::draw_into<message::Form::Wire>(wire, draw);
  wire.older_count = older_count;
  for (PortSample& older : wire.older) older = message::for_repetition(older);
  if (wire.echo_ns == message::kNothingHeard) {
    wire.hold_us = 0;
    wire.newest_number = 0;
    wire.before_newest = 0;
  }
  return wire;
}

inline WireTelegram rounded_as_on_wire(WireTelegram wire) {
  message::round_as_on_wire(wire);
  wire.telegram.site.map_cell.at = {};  // an instant of its site's own
  return wire;
}

}  // namespace palp::link
