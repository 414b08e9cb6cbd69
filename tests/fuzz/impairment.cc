// Input: an impairment as text, and the text of a profile.
#include "netem/impairment.h"

#include "common/core/check.h"
#include "netem/presets.h"
#include "tests/fuzz/fuzz.h"

namespace palp::netem {
namespace {

bool share(double value) { return value >= 0 && value <= 1; }
bool span(Duration value) { return value >= Duration{0} && value <= kTimeMax; }

void limits(const Impairment& impairment) {
  const DelayLaw& delay = impairment.delay;
  PALP_CHECK(span(delay.mean) && span(delay.jitter) && span(delay.correlation_time) &&
                 share(delay.floor) && share(delay.correlation),
             "a delay law keeps its limits");
  PALP_CHECK(share(impairment.loss) && share(impairment.duplicate), "probabilities are shares");
  PALP_CHECK(impairment.burst.rate >= 0 && impairment.burst.rate <= kBurstRateMax &&
                 span(impairment.burst.length),
             "a burst law keeps its limits");
  const GilbertLaw& gilbert = impairment.gilbert;
  PALP_CHECK(share(gilbert.loss_bad) && share(gilbert.loss_good), "losses are shares");
  PALP_CHECK(gilbert == GilbertLaw{} || (gilbert.good >= kStayMin && gilbert.bad >= kStayMin),
             "stays bound the work per datagram");
  PALP_CHECK(impairment.blackouts.size() <= kBlackoutsMax, "blackouts are few");
  for (const Blackout& blackout : impairment.blackouts) {
    PALP_CHECK(span(blackout.from) && blackout.length > Duration{0}, "a blackout is a span");
  }
}

void round_trip(const Impairment& impairment) {
  const std::string words = to_string(impairment);
  const auto again = parse_impairment(words);
  PALP_CHECK(again.has_value(), "the words of an impairment are understood");
  PALP_CHECK(*again == impairment, "the words give exactly the same impairment");
  PALP_CHECK(to_string(*again) == words, "the same impairment has the same words");
}

}  // namespace
}  // namespace palp::netem

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = palp::fuzz::as_text(data, size);
  if (const auto impairment = palp::netem::parse_impairment(text)) {
    palp::netem::limits(*impairment);
    palp::netem::round_trip(*impairment);
  } else {
    PALP_CHECK(!impairment.error().text.empty(), "a refusal says why");
  }
  if (const auto preset = palp::netem::parse_preset("fuzz", text)) {
    for (const auto& direction : {preset->up, preset->down}) {
      palp::netem::limits(direction);
      palp::netem::round_trip(direction);
    }
  } else {
    PALP_CHECK(!preset.error().text.empty(), "a refusal says why");
  }
  return 0;
}
