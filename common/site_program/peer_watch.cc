#include "common/site_program/peer_watch.h"

#include "common/config/number.h"

namespace palp::site_program {
namespace {

std::string milliseconds_text(Duration span) {
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(span).count()) +
         " ms";
}

}  // namespace

std::optional<Ending> PeerWatch::judge(const link::LinkHealth& link, TimePoint now) {
  if (link.state == LinkState::Live || link.state == LinkState::Hold) {
    worked_at_ = now;
    ever_ = true;
    return std::nullopt;
  }
  if (now - worked_at_ < config_.patience) return std::nullopt;
  const std::string waited = config::number_text(seconds(config_.patience)) + " s";
  if (ever_) {
    return Ending{config::ExitCode::CutShort,
                  "peer lost",
                  "the peer at " + config_.peer + " has been silent for " + waited};
  }
  if (link.round_trip_min > config_.round_trip_max) {
    return Ending{config::ExitCode::CannotOpen,
                  "unreachable",
                  "no session with " + config_.peer + ": its round trip of " +
                      milliseconds_text(link.round_trip_min) + " is above the limit of " +
                      milliseconds_text(config_.round_trip_max)};
  }
  return Ending{config::ExitCode::CannotOpen,
                "unreachable",
                "no session with " + config_.peer + " within " + waited + ": nobody answers there"};
}

}  // namespace palp::site_program
