#pragma once

#include <string>
#include <vector>

#include "common/core/result.h"
#include "review/replay.h"

namespace palp::review {

/// What is asked of `palp-review replay`.
struct ReplayAsk {
  std::string coupling{};          ///< empty: the session's own; another one's is refused
  std::string estimator{};         ///< another one; empty: the session's own
  std::vector<std::string> set{};  ///< "path=value" over the session's settings
  [[nodiscard]] bool another() const {
    return !coupling.empty() || !estimator.empty() || !set.empty();
  }
};

struct ReplayAnswer {
  bool same{true};   ///< nothing was asked for but the same again, and it was not
  std::string text;  ///< for people, whole lines
};

/// Does the files of one run of a site again, with the settings attached to the first; or says what
/// others would have said. Bad input is one sentence.
[[nodiscard]] Result<ReplayAnswer> replay_command(const RunBytes& files, const ReplayAsk& ask);

}  // namespace palp::review
