#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/config/command_line.h"
#include "common/plot/picture.h"
#include "lab/verbs.h"

namespace palp::lab {

/// `palp-lab impedance`, as given.
struct ImpedanceFlags {
  std::string coupling{};  ///< empty: all
  std::string round_trips_ms{"0,20,100,300"};
  std::string frequencies_hz{"1,2,5,10,20"};
  std::string stiffnesses{"100,300,1000"};  ///< [N/m]
  double amplitude_mm{0.2};
  std::optional<std::uint64_t> cores{};  ///< nothing: all
  std::string report{};
  std::string csv{};
  plot::PictureFlags picture{};
};

void declare_impedance(config::CommandLine& line, ImpedanceFlags& flags);
[[nodiscard]] config::ExitStatus run_impedance(const ImpedanceFlags& flags, const Machine& machine);

}  // namespace palp::lab
