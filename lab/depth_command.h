#pragma once

#include <string>

#include "common/config/command_line.h"
#include "common/config/submission.h"
#include "common/plot/picture.h"
#include "lab/plan/depth_study.h"
#include "lab/verbs.h"

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
  plot::PictureFlags picture{};
  std::string cases{};  ///< from which a run goes on, or is put together
  std::string shard{};  ///< "i/n"; empty: all
  bool resume{};
  config::Submission submission{.form = shard_form()};
};

void declare_depth(config::CommandLine& line, DepthFlags& flags);
/// On a process for each core.
[[nodiscard]] config::ExitStatus run_depth(const DepthFlags& flags, const Machine& machine = {});
/// The cases files of all shards; `flags` say what to write.
[[nodiscard]] config::ExitStatus merge_depth(const std::vector<std::string>& files,
                                             const DepthFlags& flags);

}  // namespace palp::lab
