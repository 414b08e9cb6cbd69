#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include <rapidcheck.h>

#include "netem/model/impairment.h"

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

/// Of a thing that may be off.
inline rc::Gen<Chance> any_chance() {
  return rc::gen::map(rc::gen::tuple(rc::gen::arbitrary<bool>(), any_share(), any_share()),
                      [](const auto& parts) {
                        const auto& [on, share, correlation] = parts;
                        return on ? Chance{share, correlation} : Chance{};
                      });
}

inline DelayLaw make_delay(Duration most) {
  constexpr std::array kShapes{DelayShape::Uniform,
                               DelayShape::Normal,
                               DelayShape::Pareto,
                               DelayShape::ParetoNormal,
                               DelayShape::LogNormal};
  DelayLaw law;
  law.mean = *any_time({}, most);
  law.floor = *any_share();
  law.jitter = *any_time({}, most / 4);
  if (law.jitter == Duration{}) return law;
  law.shape = *rc::gen::elementOf(kShapes);
  const int kind = *rc::gen::inRange(0, 3);
  if (kind == 1) law.correlation = *any_share();
  if (kind == 2) law.correlation_time = *any_time(Duration{1}, most);
  return law;
}

inline void add_losses(Impairment& impairment, Duration most) {
  impairment.loss = *any_chance();
  const auto half = [] { return *any_share() / 2; };
  if (*rc::gen::arbitrary<bool>()) {
    impairment.state = FourStateLaw{half(), half(), half(), *any_share(), half()};
  } else if (*rc::gen::arbitrary<bool>()) {
    impairment.gemodel = GemodelLaw{*any_share(), *any_share(), *any_share(), *any_share()};
  }
  if (*rc::gen::arbitrary<bool>()) {
    impairment.burst = {50 * *any_share(), *any_time(Duration{1}, most)};
  }
  if (*rc::gen::arbitrary<bool>()) {
    impairment.gilbert = {
        *any_time(kStayMin, most), *any_time(kStayMin, most), *any_share(), *any_share()};
  }
}

inline void add_line(Impairment& impairment, Duration most) {
  if (*rc::gen::arbitrary<bool>()) {
    impairment.rate = {*rc::gen::inRange<std::uint64_t>(1000, 1'000'000'000),
                       *rc::gen::inRange(-20, 20),
                       *rc::gen::inRange<std::uint32_t>(0, 100),
                       *rc::gen::inRange(-5, 5)};
    impairment.queue.packets = *rc::gen::inRange<std::uint64_t>(0, 100);
    impairment.queue.codel = *rc::gen::arbitrary<bool>();
  }
  if (*rc::gen::arbitrary<bool>()) {
    impairment.slot.min = *any_time(std::chrono::microseconds{100}, most);
    impairment.slot.max = *any_time(impairment.slot.min, most);
    impairment.slot.packets = *rc::gen::inRange<std::uint64_t>(0, 10);
  }
}

/// Anything that can be said without a file, with times up to `most`. Draws as it goes: to be
/// called inside a property.
inline Impairment make_impairment(Duration most) {
  Impairment impairment;
  impairment.delay = make_delay(most);
  add_losses(impairment, most);
  add_line(impairment, most);
  impairment.duplicate = *any_chance();
  impairment.corrupt = *any_chance();
  impairment.corrupt_payload = *rc::gen::arbitrary<bool>();
  impairment.truncate = *any_chance();
  if (impairment.truncate != Chance{})
    impairment.truncate_to = *rc::gen::inRange<std::uint64_t>(0, 300);
  if (impairment.delay.mean > Duration{} && *rc::gen::arbitrary<bool>()) {
    impairment.reorder = {*any_chance(), *rc::gen::inRange<std::uint32_t>(1, 10)};
  }
  if (*rc::gen::arbitrary<bool>()) {
    impairment.stall = {*any_share(), *any_time(Duration{1}, most), *any_share()};
  }
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    impairment.blackouts.push_back({*any_time({}, most), *any_time(Duration{1}, most)});
  }
  impairment.limit = *rc::gen::inRange<std::uint64_t>(0, 200);
  impairment.dscp_clear = *rc::gen::arbitrary<bool>();
  impairment.order = *rc::gen::element(Order::Keep, Order::Netem, Order::Swap);
  if (impairment.order == Order::Swap) {
    impairment.swap = {*any_share(), *any_share()};
    impairment.swap_depth = *rc::gen::inRange<std::uint32_t>(1, 10);
  }
  return impairment;
}

}  // namespace palp::netem
