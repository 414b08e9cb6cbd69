#pragma once

#include <cstddef>

/// Yes or no: sensitivity and criterion (Green and Swets 1966). Pure.
namespace palp::study {

struct YesNoCounts {
  std::size_t hits{};          ///< "yes" to a signal
  std::size_t signals{};       ///< >= hits
  std::size_t false_alarms{};  ///< "yes" to none
  std::size_t blanks{};        ///< >= false_alarms
};

struct Sensitivity {
  double d_prime{};       ///< [-]
  double criterion{};     ///< [-], above 0: rather "no"
  double d_prime_sd{};    ///< [-]
  double criterion_sd{};  ///< [-]
};

/// Shares with half an answer and one trial added, so that none is 0 or 1 (log-linear, Hautus
/// 1995); standard deviations to first order.
[[nodiscard]] Sensitivity sensitivity(const YesNoCounts& counts) noexcept;

}  // namespace palp::study
