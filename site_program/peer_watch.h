#pragma once

#include <optional>
#include <string>

#include "common/core/time.h"
#include "common/link/telegram.h"
#include "site_program/exit_status.h"

namespace palp::site_program {

struct PeerWatchConfig {
  std::string peer;                                      ///< as people know it: "127.0.0.1:9000"
  Duration patience_at_first{std::chrono::seconds{30}};  ///< while no link has worked yet
  Duration patience{std::chrono::seconds{120}};          ///< since one last worked
  Duration round_trip_max{std::chrono::milliseconds{2500}};  ///< above it no link comes about
};

/// When to give up on the peer: no link worked for too long. Told the time. Thread: main.
class PeerWatch {
 public:
  PeerWatch(const PeerWatchConfig& config, TimePoint began_at)
      : config_{config}, worked_at_{began_at} {}

  /// nullopt: go on.
  [[nodiscard]] std::optional<ExitStatus> judge(const LinkHealth& link, TimePoint now);
  /// The peer, or whoever is there, has refused; empty: nothing new.
  void note_refusal(const std::string& sentence) {
    if (!sentence.empty()) refusal_ = sentence;
  }
  [[nodiscard]] bool ever_worked() const noexcept { return ever_; }
  /// How a wait of this length ends in which no link ever worked.
  [[nodiscard]] ExitStatus unreachable(const LinkHealth& link, Duration waited) const;

 private:
  PeerWatchConfig config_;
  TimePoint worked_at_;  ///< last, or since when one is waited for
  bool ever_{};
  std::string refusal_;  ///< the last; empty: nobody said anything
};

}  // namespace palp::site_program
