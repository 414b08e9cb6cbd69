#pragma once

#include <bit>

#include "common/link/codec.h"

/// Equal to the last bit, so that -0.0 is not 0.0.
namespace palp::link {

inline bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

struct SamePayload {
  bool operator()(std::monostate, std::monostate) const { return true; }
  bool operator()(const WavePayload& a, const WavePayload& b) const {
    return same(a.wave_integral, b.wave_integral) && same(a.wave_energy, b.wave_energy);
  }
  bool operator()(const TdpaPayload& a, const TdpaPayload& b) const {
    return same(a.energy_in, b.energy_in);
  }
  bool operator()(const ModelPayload& a, const ModelPayload& b) const {
    return a.version == b.version && same(a.c[0], b.c[0]) && same(a.c[1], b.c[1]) &&
           same(a.c[2], b.c[2]) && same(a.c[3], b.c[3]) && same(a.c[4], b.c[4]) &&
           same(a.swing, b.swing) && same(a.swing_quadrature, b.swing_quadrature) &&
           same(a.swing_rate, b.swing_rate) && same(a.relaxing[0], b.relaxing[0]) &&
           same(a.relaxing[1], b.relaxing[1]) && same(a.surface, b.surface) &&
           same(a.depth_max, b.depth_max) && same(a.residual, b.residual);
  }
  template <class A, class B>
  bool operator()(const A&, const B&) const {
    return false;
  }
};

inline bool same(const PortSample& a, const PortSample& b) {
  return same(a.position, b.position) && same(a.velocity, b.velocity) && same(a.force, b.force) &&
         std::visit(SamePayload{}, a.payload, b.payload);
}

inline bool same(const SiteReport& a, const SiteReport& b) {
  const DepthReport& p = a.depth;
  const DepthReport& q = b.depth;
  return a.state == b.state && a.epoch == b.epoch && same(a.place.x, b.place.x) &&
         same(a.place.y, b.place.y) && p.number == q.number && p.verdict == q.verdict &&
         p.reason == q.reason && same(p.depth, q.depth) && same(p.depth_stddev, q.depth_stddev) &&
         same(p.depth_low, q.depth_low) && same(p.depth_high, q.depth_high) && same(p.hash, q.hash);
}

inline bool same(const WireTelegram& a, const WireTelegram& b) {
  if (a.older_count != b.older_count) return false;
  for (std::size_t i = 0; i < a.older_count; ++i) {
    if (!same(a.older[i], b.older[i])) return false;
  }
  return a.sent_at_ns == b.sent_at_ns && a.echo_ns == b.echo_ns &&
         a.newest_number == b.newest_number && a.before_newest == b.before_newest &&
         a.hold_us == b.hold_us && same(a.telegram.site, b.telegram.site) &&
         same(a.telegram.port, b.telegram.port);
}

}  // namespace palp::link
