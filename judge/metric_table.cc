#include "judge/metric_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palp::judge {
namespace {

using M = RunMetrics;

/// [N], beyond 1.5 times what a finger would press, or 0.5 N more.
double excess_force(const M& m) {
  const double allowed = std::max(1.5 * m.contact.force_direct, m.contact.force_direct + 0.5);
  return std::isnan(allowed) ? allowed : std::max(0.0, m.contact.force_max - allowed);
}

/// [N], beyond what a finger would press.
double tip_force_excess(const M& m) {
  const double excess = m.contact.force_max - m.contact.force_direct;
  return std::isnan(excess) ? excess : std::max(0.0, excess);
}

double missing_share(const M& m) {
  const double missing = m.contact.share_permitted - m.contact.share_2s;
  return std::isnan(missing) ? missing : std::max(0.0, missing);
}

double share_error(const M& m) {
  const bool all = m.contact.share_permitted >= PermittedPress::kAll;
  return all ? m.contact.share_2s - 1 : kUndefined;
}

constexpr std::array kTable{
    Metric{"tap_a_error",
           "error of the stiffness felt, taps at A [%]",
           100,
           [](const M& m) { return m.tap_error[0]; }},
    Metric{"tap_b_error",
           "error of the stiffness felt, taps at B [%]",
           100,
           [](const M& m) { return m.tap_error[1]; }},
    Metric{"tap1_a_error",
           "error of the stiffness felt, first tap at A [%]",
           100,
           [](const M& m) { return m.tap1_error[0]; }},
    Metric{"tap1_b_error",
           "error of the stiffness felt, first tap at B [%]",
           100,
           [](const M& m) { return m.tap1_error[1]; }},
    Metric{"tap2_a_error",
           "error of the stiffness felt, second tap at A [%]",
           100,
           [](const M& m) { return m.tap2_error[0]; }},
    Metric{"tap2_b_error",
           "error of the stiffness felt, second tap at B [%]",
           100,
           [](const M& m) { return m.tap2_error[1]; }},
    Metric{"ratio_error",
           "error of the ratio felt, B to A, taps [%]",
           100,
           [](const M& m) { return m.ratio_error; }},
    Metric{"ratio_true",
           "true ratio of the stiffness, B to A [-]",
           1,
           [](const M& m) { return m.ratio_true; }},
    Metric{"contrast",
           "contrast felt to true contrast, B to A [%]",
           100,
           [](const M& m) { return m.contrast; }},
    Metric{"stat_a_error",
           "error of the stiffness felt, holds at A [%]",
           100,
           [](const M& m) { return m.static_error[0]; }},
    Metric{"stat_b_error",
           "error of the stiffness felt, holds at B [%]",
           100,
           [](const M& m) { return m.static_error[1]; }},
    Metric{"stat_ratio_error",
           "error of the ratio felt, B to A, holds [%]",
           100,
           [](const M& m) { return m.static_ratio_error; }},
    Metric{"learning_a_s",
           "time until the force is right, A [s]",
           1,
           [](const M& m) { return m.learning[0]; }},
    Metric{"learning_b_s",
           "time until the force is right, B [s]",
           1,
           [](const M& m) { return m.learning[1]; }},
    Metric{"share_2s",
           "felt over true force of a first press, after 2 s [%]",
           100,
           [](const M& m) { return m.contact.share_2s; }},
    Metric{"share_permitted",
           "the same, as much as the energy permits [%]",
           100,
           [](const M& m) { return m.contact.share_permitted; }},
    Metric{"share_missing", "of what the energy permits, not felt [%]", 100, missing_share},
    Metric{
        "share_error", "error of a first press where the energy permits all [%]", 100, share_error},
    Metric{"announced",
           "incomplete forces that the surgeon was told of [%]",
           100,
           [](const M& m) { return m.contact.announced; }},
    Metric{"known_tap_a_error",
           "error of the stiffness felt, taps at A once it is known [%]",
           100,
           [](const M& m) { return m.contact.known_tap_error[0]; }},
    Metric{"known_tap_b_error",
           "error of the stiffness felt, taps at B once it is known [%]",
           100,
           [](const M& m) { return m.contact.known_tap_error[1]; }},
    Metric{"held_a_error",
           "error of the force held at A once it is known [%]",
           100,
           [](const M& m) { return m.contact.held_error[0]; }},
    Metric{"held_b_error",
           "error of the force held at B once it is known [%]",
           100,
           [](const M& m) { return m.contact.held_error[1]; }},
    Metric{"force_rms_n",
           "error of the force in taps, rms [N]",
           1,
           [](const M& m) { return m.force_rms; }},
    Metric{
        "drag_rms_n", "force felt in free air, rms [N]", 1, [](const M& m) { return m.drag_rms; }},
    Metric{"drag_peak_n",
           "force felt in free air, largest [N]",
           1,
           [](const M& m) { return m.drag_peak; }},
    Metric{"drift_mm",
           "distance of hand and tip at rest [mm]",
           1,
           [](const M& m) { return m.drift * 1e3; }},
    Metric{"energy_operator_mj",
           "energy given to the hand [mJ]",
           1,
           [](const M& m) { return m.energy_operator * 1e3; }},
    Metric{"energy_net_mj",
           "energy given beyond the tissue's [mJ]",
           1,
           [](const M& m) { return m.energy_net * 1e3; }},
    Metric{"energy_contact_mj",
           "most energy given to the hand in one contact [mJ]",
           1,
           [](const M& m) { return m.contact.energy_contact * 1e3; }},
    Metric{"energy_air_to_air_mj",
           "most energy given to the hand from air to air [mJ]",
           1,
           [](const M& m) { return m.contact.energy_air_to_air * 1e3; }},
    Metric{"force_step_10ms_n",
           "largest step of the force in 10 ms [N]",
           1,
           [](const M& m) { return m.force_step_10ms; }},
    Metric{"force_step_event_10ms_n",
           "largest step not of the hand's motion, 10 ms [N]",
           1,
           [](const M& m) { return m.force_step_event; }},
    Metric{"force_step_guarded_10ms_n",
           "largest step of the force, whole run, 10 ms [N]",
           1,
           [](const M& m) { return m.whole.force_step; }},
    Metric{"force_kick_10ms_n",
           "largest kick, 10 ms [N]",
           1,
           [](const M& m) { return m.whole.force_kick; }},
    Metric{"force_drop_10ms_n",
           "largest drop of the force, 10 ms [N]",
           1,
           [](const M& m) { return m.whole.force_drop; }},
    Metric{"force_unexplained_10ms_n",
           "largest step that no motion explains, 10 ms [N]",
           1,
           [](const M& m) { return m.whole.force_unexplained; }},
    Metric{"energy_given_mj",
           "energy given to the hand, whole run [mJ]",
           1,
           [](const M& m) { return m.whole.energy_given * 1e3; }},
    Metric{"force_peak_n", "largest force felt [N]", 1, [](const M& m) { return m.force_peak; }},
    Metric{"contact_force_max_n",
           "largest force at the tissue [N]",
           1,
           [](const M& m) { return m.contact.force_max; }},
    Metric{"contact_force_direct_n",
           "largest force of the same hand's finger [N]",
           1,
           [](const M& m) { return m.contact.force_direct; }},
    Metric{
        "contact_force_excess_n", "force of the tip beyond what is allowed [N]", 1, excess_force},
    Metric{"tip_force_ratio",
           "largest force at the tissue to that of the same hand's finger [-]",
           1,
           [](const M& m) { return m.contact.force_max / m.contact.force_direct; }},
    Metric{"tip_force_excess_n",
           "force of the tip beyond that of the same hand's finger [N]",
           1,
           tip_force_excess},
    Metric{"guard_excess_n",
           "force of the tip beyond the gate's limit [N]",
           1,
           [](const M& m) { return m.contact.guard_excess; }},
    Metric{"guard_excess_s",
           "longest time of the tip beyond the gate's limit [s]",
           1,
           [](const M& m) { return m.contact.guard_excess_time; }},
    Metric{"unstable_hand",
           "the hand was unstable [-]",
           1,
           [](const M& m) { return m.contact.unstable_hand ? 1.0 : 0.0; }},
    Metric{"unstable_tip",
           "the tip was unstable [-]",
           1,
           [](const M& m) { return m.contact.unstable_tip ? 1.0 : 0.0; }},
    Metric{"hand_swing_mm",
           "limit cycle of the hand [mm]",
           1,
           [](const M& m) { return m.contact.hand_swing * 1e3; }},
    Metric{"tip_swing_mm",
           "limit cycle of the tip [mm]",
           1,
           [](const M& m) { return m.contact.tip_swing * 1e3; }},
    Metric{"drag_bump_error",
           "largest force felt in a drag to the tip's [%]",
           100,
           [](const M& m) { return m.contact.drag_error; }},
    Metric{"drag_direct_error",
           "largest force felt in a drag to a finger's [%]",
           100,
           [](const M& m) { return m.contact.drag_felt / m.contact.drag_direct - 1; }},
    Metric{"drag_shift_s",
           "bump of a drag, later than at the tip [s]",
           1,
           [](const M& m) { return m.contact.drag_shift; }},
    Metric{"phantom_force_n",
           "force felt in the air in a blackout [N]",
           1,
           [](const M& m) { return m.phantom_force; }},
    Metric{"stage_speed_max_m_per_s",
           "largest speed of the stage in a blackout [m/s]",
           1,
           [](const M& m) { return m.stage_speed_max; }},
};

}  // namespace

std::span<const Metric> metric_table() noexcept { return kTable; }

std::optional<std::size_t> metric_index(std::string_view name) noexcept {
  const auto* const found = std::find_if(
      kTable.begin(), kTable.end(), [&](const Metric& metric) { return metric.name == name; });
  if (found == kTable.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kTable.begin());
}

}  // namespace palp::judge
