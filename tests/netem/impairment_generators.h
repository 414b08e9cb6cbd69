#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include <rapidcheck.h>

#include "netem/impairment.h"

/// Generators of impairments for property tests.
namespace palp::netem {

inline rc::Gen<Duration> any_time(Duration least, Duration most) {
  return rc::gen::map(rc::gen::inRange<std::int64_t>(least.count(), most.count() + 1),
                      [](std::int64_t count) { return Duration{count}; });
}

/// Shares with 0 and 1 among them.
inline rc::Gen<double> any_share() {
  return rc::gen::weightedOneOf<double>(
      {{1, rc::gen::just(0.0)},
       {1, rc::gen::just(1.0)},
       {6, rc::gen::map(rc::gen::inRange<std::int64_t>(0, 1'000'000'007), [](std::int64_t count) {
          return static_cast<double>(count) / 1'000'000'007.0;
        })}});
}

inline rc::Gen<DelayLaw> any_delay(Duration most) {
  return rc::gen::map(rc::gen::tuple(any_time({}, most),
                                     any_time({}, most / 4),
                                     rc::gen::arbitrary<bool>(),
                                     any_share(),
                                     rc::gen::inRange(0, 3),
                                     any_share(),
                                     any_time(Duration{1}, most)),
                      [](const auto& parts) {
                        const auto& [mean, jitter, normal, floor, kind, correlation, memory] =
                            parts;
                        DelayLaw law;
                        law.mean = mean;
                        law.floor = floor;
                        law.jitter = jitter;
                        if (jitter == Duration{}) return law;
                        law.shape = normal ? DelayShape::Normal : DelayShape::Uniform;
                        if (kind == 1) law.correlation = correlation;
                        if (kind == 2) law.correlation_time = memory;
                        return law;
                      });
}

/// Anything that can be said, with times up to `most`.
inline rc::Gen<Impairment> any_impairment(Duration most) {
  const auto burst = rc::gen::map(
      rc::gen::tuple(rc::gen::arbitrary<bool>(), any_share(), any_time(Duration{1}, most)),
      [](const auto& parts) {
        const auto& [on, rate, length] = parts;
        return on ? BurstLaw{50 * rate, length} : BurstLaw{};
      });
  const auto gilbert =
      rc::gen::map(rc::gen::tuple(rc::gen::arbitrary<bool>(),
                                  any_time(kStayMin, most),
                                  any_time(kStayMin, most),
                                  any_share(),
                                  any_share()),
                   [](const auto& parts) {
                     const auto& [on, good, bad, loss_bad, loss_good] = parts;
                     return on ? GilbertLaw{good, bad, loss_bad, loss_good} : GilbertLaw{};
                   });
  const auto blackout = rc::gen::map(rc::gen::pair(any_time({}, most), any_time(Duration{1}, most)),
                                     [](const auto& parts) {
                                       return Blackout{parts.first, parts.second};
                                     });
  const auto blackouts = rc::gen::mapcat(rc::gen::inRange<std::size_t>(0, 4), [=](std::size_t n) {
    return rc::gen::container<std::vector<Blackout>>(n, blackout);
  });
  return rc::gen::map(
      rc::gen::tuple(any_delay(most),
                     any_share(),
                     burst,
                     gilbert,
                     any_share(),
                     blackouts,
                     rc::gen::arbitrary<bool>()),
      [](const auto& parts) {
        const auto& [delay, loss, bursts, stays, duplicate, dark, free] = parts;
        return Impairment{
            delay, loss, bursts, stays, duplicate, dark, free ? Order::Free : Order::Keep};
      });
}

}  // namespace palp::netem
