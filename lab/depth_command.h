#pragma once

#include <string>

#include "common/config/command_line.h"
#include "lab/plan/depth_study.h"

namespace palp::lab {

/// `palp-lab depth`, as given.
struct DepthFlags {
  std::string depths_mm{};  ///< "5,10,15"
  std::uint64_t count{100};
  std::uint64_t repeats{10};
  std::uint64_t seed{1};
  std::string estimator{"bayes"};
  std::uint64_t taps{4};
  std::uint64_t reference_taps{4};
  double rtt_ms{20};
  double loss{};  ///< [-]
  std::string coupling{};
  bool wide{};
  std::uint64_t cores{2};
  std::string report{};
  std::string csv{};
  std::string svg{};
};

void declare_depth(config::CommandLine& line, DepthFlags& flags);
[[nodiscard]] config::ExitStatus run_depth(const DepthFlags& flags);

}  // namespace palp::lab
