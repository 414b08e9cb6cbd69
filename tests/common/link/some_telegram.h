#pragma once

#include "common/core/random.h"
#include "common/link/codec.h"

/// Well formed telegrams for tests: everything they hold is drawn from a seed.
namespace palp::link {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_{seed} {}
  std::uint64_t bits() { return random_bits(seed_, 0, next_++); }
  std::uint64_t below(std::uint64_t limit) { return bits() % limit; }
  /// In [-limit, limit]: mostly ordinary, now and then an edge.
  double within(double limit) {
    switch (below(8)) {
      case 0:
        return 0.0;
      case 1:
        return -0.0;
      case 2:
        return limit;
      case 3:
        return -limit;
      default:
        return limit * (2 * random_uniform(seed_, 1, next_++) - 1);
    }
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_{};
};

inline CouplingPayload some_payload(Draw& draw, bool earlier) {
  switch (draw.below(earlier ? 2 : 4)) {
    case 1:
      return WavePayload{draw.within(kSumMax), draw.within(kSumMax)};
    case 2:
      return TdpaPayload{draw.within(kSumMax)};
    case 3:
      return ModelPayload{.version = static_cast<std::uint32_t>(draw.bits()),
                          .c = {draw.within(kForceMax),
                                draw.within(kForceMax),
                                draw.within(kForceMax),
                                draw.within(kForceMax),
                                draw.within(kForceMax)},
                          .surface = draw.within(kLengthMax),
                          .depth_max = draw.within(kLengthMax),
                          .residual = draw.within(kForceMax),
                          .swing = draw.within(kLengthMax),
                          .swing_quadrature = draw.within(kLengthMax),
                          .swing_rate = draw.within(kSpeedMax),
                          .relaxing = {draw.within(kForceMax), draw.within(kForceMax)}};
    default:
      return std::monostate{};
  }
}

inline PortSample some_sample(Draw& draw, bool earlier = false) {
  return {.position = draw.within(kLengthMax),
          .velocity = draw.within(kSpeedMax),
          .force = draw.within(kForceMax),
          .payload = some_payload(draw, earlier)};
}

inline DepthReport some_depth(Draw& draw) {
  const auto number = static_cast<std::uint32_t>(draw.below(3));
  if (number == 0) return {};  // none yet
  return {.number = number,
          .verdict = static_cast<DepthVerdict>(draw.below(kDepthVerdictCount)),
          .reason = static_cast<DepthReason>(draw.below(kDepthReasonCount)),
          .depth = draw.within(kLengthMax),
          .depth_stddev = draw.within(kLengthMax),
          .depth_low = draw.within(kLengthMax),
          .depth_high = draw.within(kLengthMax),
          .hash = draw.within(kForceMax)};
}

inline WireTelegram some_telegram(std::uint64_t seed) {
  Draw draw{seed};
  WireTelegram wire;
  wire.sent_at_ns = draw.below(kSentAtMaxNs + 1);
  if (draw.below(4) != 0) {
    wire.echo_ns = draw.below(kSentAtMaxNs + 1);
    wire.newest_number = draw.below(kNumberMax + 1);
    wire.before_newest = static_cast<std::uint32_t>(draw.bits());
    wire.hold_us = static_cast<std::uint32_t>(draw.below(kHoldMaxUs + 1));
  }
  wire.telegram.site = {.state = static_cast<SiteState>(draw.below(kSiteStateCount)),
                        .epoch = static_cast<std::uint32_t>(draw.bits()),
                        .place = {draw.within(kLengthMax), draw.within(kLengthMax)},
                        .depth = some_depth(draw)};
  wire.telegram.port = some_sample(draw);
  wire.older_count = static_cast<std::uint8_t>(draw.below(3));
  for (std::size_t i = 0; i < wire.older_count; ++i) wire.older[i] = some_sample(draw, true);
  return wire;
}

/// As it comes out of the schema's `float` fields; sums stay double.
inline void round_as_on_wire(double& value) { value = double{static_cast<float>(value)}; }

inline void round_as_on_wire(PortSample& sample) {
  round_as_on_wire(sample.position);
  round_as_on_wire(sample.velocity);
  round_as_on_wire(sample.force);
  if (auto* model = std::get_if<ModelPayload>(&sample.payload)) {
    for (double& c : model->c) round_as_on_wire(c);
    round_as_on_wire(model->surface);
    round_as_on_wire(model->depth_max);
    round_as_on_wire(model->residual);
    round_as_on_wire(model->swing);
    round_as_on_wire(model->swing_quadrature);
    round_as_on_wire(model->swing_rate);
    for (double& share : model->relaxing) round_as_on_wire(share);
  }
}

inline WireTelegram rounded_as_on_wire(WireTelegram wire) {
  round_as_on_wire(wire.telegram.site.place.x);
  round_as_on_wire(wire.telegram.site.place.y);
  DepthReport& depth = wire.telegram.site.depth;
  round_as_on_wire(depth.depth);
  round_as_on_wire(depth.depth_stddev);
  round_as_on_wire(depth.depth_low);
  round_as_on_wire(depth.depth_high);
  round_as_on_wire(depth.hash);
  round_as_on_wire(wire.telegram.port);
  for (PortSample& sample : wire.older) round_as_on_wire(sample);
  return wire;
}

}  // namespace palp::link
