#include "netem/model/prepared_law.h"

#include "common/core/check.h"
#include "netem/model/kernel_model.h"

namespace palp::netem {
namespace {

bool is_share(double value) { return value >= 0 && value <= 1; }

bool is_time(Duration value) { return value >= Duration{} && value <= kTimeMax; }

bool is_chance(const Chance& chance) {
  return is_share(chance.share) && is_share(chance.correlation);
}

bool is_sound(const Impairment& impairment) {
  const DelayLaw& delay = impairment.delay;
  const GilbertLaw& gilbert = impairment.gilbert;
  const bool stays =
      gilbert.bad == Duration{} || (gilbert.good >= kStayMin && gilbert.bad >= kStayMin);
  return is_time(delay.mean) && is_time(delay.jitter) && is_share(delay.floor) &&
         is_share(delay.correlation) && is_time(delay.correlation_time) &&
         is_chance(impairment.loss) && is_chance(impairment.duplicate) &&
         is_chance(impairment.corrupt) && is_chance(impairment.swap) &&
         impairment.burst.rate >= 0 && impairment.burst.rate <= kBurstRateMax &&
         is_time(impairment.burst.length) && is_time(gilbert.good) && is_time(gilbert.bad) &&
         is_share(gilbert.loss_bad) && is_share(gilbert.loss_good) && stays &&
         impairment.swap_depth <= kSwapDepthMax;
}

DelayLaw law_of_slots(const Impairment& impairment) {
  return impairment.slot.spacing.value_or(DelayLaw{});
}

}  // namespace

PreparedLaw::PreparedLaw(const Impairment& asked)
    : impairment{asked},
      curve{asked.delay},
      carry{asked.mode == Mode::Exact ? curve.normal_correlation(asked.delay.correlation) : 0},
      slot_curve{law_of_slots(asked)},
      table{kernel_table(asked.delay)},
      slot_table{kernel_table(law_of_slots(asked))} {
  PALP_CHECK(is_sound(asked), "an impairment's shares lie in 0..1 and its times in 0..kTimeMax");
}

}  // namespace palp::netem
