#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "lab/run/scenario.h"

/// Many runs as a list: a set of scenarios, a map, a sweep. A plan is text and numbers only; a case
/// becomes a Scenario when it is its turn, so that a thousand of them cost nothing until then.
namespace palp::lab {

/// A field of LabScenario and its value. "coupling.*" and "loop.*" are set at both sites; "rtt_ms"
/// is half of it as delay each way; a path's "spec" replaces the numbers it had.
struct Setting {
  std::string path;
  std::string value;
};

struct Case {
  std::uint64_t index{};  ///< in the whole plan, whatever the shard
  std::uint64_t seed{};
  std::vector<Setting> settings;
  std::vector<std::string> labels;  ///< one per name in Plan::label_names
  Fault fault;                      ///< `at_script_time` is found from `fault_place`
  std::string_view fault_place;     ///< of kFaultPlaces; empty: see `fault_share`
  double fault_share{};             ///< [-], of the script's length, where it begins
  bool lying{};                     ///< the patient's site lies
  std::string script{};             ///< text of the hand's; empty: that of the settings
};

/// In the middle of: a sine in the air, the second tap and the deep press of the first site, the
/// deep press of the second.
inline constexpr std::array<std::string_view, 4> kFaultPlaces{"air", "tap", "press", "press-b"};

struct Plan {
  std::string name;
  std::string scenario{"standard"};  ///< what the settings change
  std::uint64_t seed{};
  std::string coupling;  ///< empty: not the same in all cases
  std::string tissue;    ///< empty: not the same in all cases
  std::vector<std::string> label_names;
  std::vector<Case> cases;
  std::uint64_t count{};  ///< of cases, before a shard was taken out
  bool lying{};           ///< the patient's site sends random models
  std::string made_by;    ///< program and machine that run it; no part of what it is
  bool direct_touch{};    ///< each case is held against what its hand would press with a finger
  bool blackout{};        ///< a blackout of 2 s lies in the middle of A's deep press
};

/// A name that may be asked for, and what is behind it.
struct NamedChoice {
  std::string name;
  std::string means;
};

/// What a set is made for.
struct PlanAsk {
  std::uint64_t count{1000};  ///< cases of the random sets
  std::uint64_t seed{1};
  std::string coupling{"mmt"};
  std::string tissue{"closed-form"};  ///< closed-form or fe (both with the case's inclusion), or
                                      ///< any phantom
};

/// table, net, mc, mc-hard, mc-noise, mc-adv, grips, inc, blackout, breath, long, faults, pauses,
/// device-faults, wild, first, devices, gestures. Random sets draw case i from (seed, i) alone, so
/// that the first 100 of 1000 are the first 100 of 100.
[[nodiscard]] Result<Plan> make_set(const std::string& name, const PlanAsk& ask);
[[nodiscard]] std::vector<NamedChoice> described_sets();

/// The stability map of eq. (1): spring by round trip by grip.
[[nodiscard]] Plan make_map(const PlanAsk& ask);

/// All combinations of "path=value,value,..." over a scenario, with `repeats` seeds each. Coupling
/// and tissue (a phantom) are the scenario's where `ask` leaves them empty. Of an axis "seed" each
/// value is the first of its repeats' seeds. A path occurs once.
[[nodiscard]] Result<Plan> make_sweep(const std::string& scenario,
                                      const std::vector<std::string>& axes,
                                      std::uint64_t repeats,
                                      const PlanAsk& ask);

/// The cases with index % count == part.
struct Shard {
  std::uint64_t part{};
  std::uint64_t count{1};
};
/// "0/4": the first of four.
[[nodiscard]] Result<Shard> parse_shard(const std::string& text);
void keep_shard(Plan& plan, const Shard& shard);

[[nodiscard]] Result<Scenario> make_case(const Plan& plan, const Case& one);

}  // namespace palp::lab
