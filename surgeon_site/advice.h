#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surgeon_site/surgeon_status.h"

namespace palp::surgeon {

/// What coupling direct does at the present round trip, if that is above `round_trip_max`.
[[nodiscard]] std::optional<std::string> delay_advice(const SurgeonStatus& status,
                                                      Duration round_trip_max,
                                                      bool engagement_forced);

/// What it costs that the patient's devices are slower than 100 Hz, where they are.
[[nodiscard]] std::optional<std::string> device_advice(const DeviceFacts& peer);

struct AdviceConfig {
  std::string coupling;
  Duration direct_round_trip_max{};  ///< above it direct is warned of
  bool engagement_forced{};
};

/// What an operator is to know of a session before trusting the hand. Thread: the display's.
class Advice {
 public:
  explicit Advice(AdviceConfig config) : config_{std::move(config)} {}
  /// Whole sentences, each once.
  [[nodiscard]] std::vector<std::string> news(const SurgeonStatus& status);

 private:
  AdviceConfig config_;
  bool delay_told_{};
  bool devices_told_{};
};

}  // namespace palp::surgeon
