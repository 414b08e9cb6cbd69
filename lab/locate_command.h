#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/config/command_line.h"
#include "common/plot/picture.h"
#include "lab/verbs.h"

namespace palp::lab {

/// `palp-lab locate`, as given.
struct LocateFlags {
  std::uint64_t count{100};
  std::uint64_t seed{1};
  std::uint64_t taps{9};
  double pitch_mm{7.5};
  double heterogeneity{};  ///< [-]
  double length_mm{10};
  double assumed_spread{0.05};       ///< [-]
  double e_kpa{15.3};                ///< [kPa]
  std::optional<double> told_kpa{};  ///< [kPa]; nothing: e_kpa
  double depth_max_mm{27};
  std::string ball{};
  std::string set{};
  bool search{};
  std::string rule{};
  bool session{};
  double round_trip_ms{};
  double loss{};                         ///< [-]
  std::optional<std::uint64_t> cores{};  ///< nothing: all
  std::string report{};
  std::string csv{};
  plot::PictureFlags picture{};
};

void declare_locate(config::CommandLine& line, LocateFlags& flags);
[[nodiscard]] config::ExitStatus run_locate(const LocateFlags& flags, const Machine& machine);

}  // namespace palp::lab
