#include "site_program/peer_watch.h"

#include "common/config/number.h"

namespace palp::site_program {
namespace {

std::string milliseconds_text(Duration span) {
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(span).count()) +
         " ms";
}

}  // namespace

std::optional<ExitStatus> PeerWatch::judge(const LinkHealth& link, TimePoint now) {
  if (link.state == LinkState::Live || link.state == LinkState::Hold) {
    worked_at_ = now;
    ever_ = true;
    return std::nullopt;
  }
  const Duration patience = ever_ ? config_.patience : config_.patience_at_first;
  if (now - worked_at_ < patience) return std::nullopt;
  if (!ever_) return unreachable(link, patience);
  return ExitStatus{config::ExitCode::CutShort,
                    "peer lost",
                    "the peer at " + config_.peer + " has been silent for " +
                        config::number_text(seconds(config_.patience)) + " s"};
}

ExitStatus PeerWatch::unreachable(const LinkHealth& link, Duration waited) const {
  if (link.round_trip_min > config_.round_trip_max) {
    return {config::ExitCode::CannotOpen,
            "unreachable",
            "no session with " + config_.peer + ": its round trip of " +
                milliseconds_text(link.round_trip_min) + " is above the limit of " +
                milliseconds_text(config_.round_trip_max)};
  }
  return {config::ExitCode::CannotOpen,
          "unreachable",
          "no session with " + config_.peer + " within " + config::number_text(seconds(waited)) +
              " s: " + (refusal_.empty() ? "nobody answers there" : refusal_)};
}

}  // namespace palp::site_program
