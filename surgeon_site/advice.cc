#include "surgeon_site/advice.h"

#include <algorithm>
#include <utility>

#include "common/core/number_text.h"

namespace palp::surgeon {
namespace {

constexpr double kSlow = 100;  // [Hz], below it docs/hardware.md has what it costs

double in_milliseconds(Duration span) { return seconds(span) * 1e3; }

}  // namespace

std::optional<std::string> delay_advice(const SurgeonStatus& status,
                                        Duration round_trip_max,
                                        bool engagement_forced) {
  const LinkHealth& link = status.link;
  if (link.state != LinkState::Live || link.round_trip <= round_trip_max) return std::nullopt;
  return number_text("the round trip is ", in_milliseconds(link.round_trip), 1, " ms: ") +
         number_text("above ", in_milliseconds(round_trip_max), 0, " ms ") +
         "coupling direct is not stable, tissue feels too soft or too stiff and a light hand is "
         "shaken; it " +
         (engagement_forced ? "engages here because --force-engage was given"
                            : "does not engage here unless --force-engage is given");
}

std::optional<std::string> device_advice(const DeviceFacts& peer) {
  if (!peer.stage || !peer.sensor) return std::nullopt;
  if (std::min(peer.stage->rate, peer.sensor->rate) >= kSlow) return std::nullopt;
  return number_text("the patient's stage is read at ", peer.stage->rate, 0, " Hz, ") +
         number_text("its force at ", peer.sensor->rate, 0, " Hz: ") +
         "the first tap of a place is hardly felt, later ones some percent less exactly, and the "
         "interval of a depth holds less often than it says (docs/hardware.md)";
}

std::vector<std::string> Advice::news(const SurgeonStatus& status) {
  std::vector<std::string> news;
  const auto tell = [&](bool& told, const std::optional<std::string>& sentence) {
    if (told || !sentence) return;
    told = true;
    news.push_back(*sentence);
  };
  if (config_.coupling == "direct") {
    tell(delay_told_,
         delay_advice(status, config_.direct_round_trip_max, config_.engagement_forced));
  }
  tell(devices_told_, device_advice(status.peer_devices));
  return news;
}

}  // namespace palp::surgeon
