#pragma once

#include <cstdint>
#include <string>

#include "common/config/command_line.h"
#include "study/recovery.h"

namespace palp::study {

/// `palp-study simulate`, as given on the command line.
struct SimulateFlags {
  std::string set{"recover"};
  std::string method{"quest-plus"};
  std::uint64_t intervals{2};
  std::uint64_t observers{300};
  std::uint64_t trials{60};
  double jnd_min{0.08};    ///< [-]
  double jnd_max{0.30};    ///< [-]
  double lapse_min{};      ///< [-]
  double lapse_max{0.05};  ///< [-]
  std::uint64_t participants{16};
  double ratio{1};      ///< [-], of the conditions' JND
  double margin{0.15};  ///< [-]
  std::uint64_t seed{1};
  std::string report;
};

void declare_simulate(config::CommandLine& line, SimulateFlags& flags);
[[nodiscard]] config::ExitStatus run_simulate(const SimulateFlags& flags,
                                              const ForEachIndex& for_each_index);

/// `palp-study power`, as given on the command line.
struct PowerFlags {
  double ratio{1.25};  ///< [-], > 1
  double sd{0.35};     ///< [-]
  double power{0.8};   ///< [-]
};

void declare_power(config::CommandLine& line, PowerFlags& flags);
[[nodiscard]] config::ExitStatus run_power(const PowerFlags& flags);

}  // namespace palp::study
