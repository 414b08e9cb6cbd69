#include "common/link/health_text.h"

#include "common/core/number_text.h"

namespace palp::link {

std::string health_text(const LinkHealth& health) {
  if (health.state == LinkState::Down) return "no link";
  std::string text = number_text("rtt ", seconds(health.round_trip) * 1e3, 1, " ms");
  if (health.peer_clock) {
    text += number_text(" (there ", seconds(health.delay_out) * 1e3, 1, "") +
            number_text(", here ", seconds(health.delay_in) * 1e3, 1, ")");
  }
  const std::uint64_t all = health.accepted + health.late + health.lost;
  const double lost =
      all == 0 ? 0 : static_cast<double>(health.lost) / static_cast<double>(all) * 100;
  text += number_text("  loss ", lost, 1, " %");
  if (health.state != LinkState::Live) {
    text += number_text("  silent ", seconds(health.gap), 1, " s");
  }
  return text;
}

std::string health_brief(const LinkHealth& health) {
  if (health.state == LinkState::Down) return "no link";
  if (health.state != LinkState::Live) return number_text("silent ", seconds(health.gap), 1, " s");
  return number_text("rtt ", seconds(health.round_trip) * 1e3, 1, " ms");
}

}  // namespace palp::link
