#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "lab/plan/batch.h"

namespace palp::lab {

/// The rows of a batch as they come, in `FILE.partial` beside the cases file that is to be, so that
/// an interrupted batch is taken up again. Thread: one at a time.
class PartialCases {
 public:
  /// With `resume`, `before` gets the rows that are there and `plan` keeps the cases that are not;
  /// rows of another plan are refused. Without it, what is there is written over. `path`: of the
  /// cases file; empty, or a pipe: nothing is kept.
  [[nodiscard]] static Result<PartialCases> begin(const std::string& path,
                                                  bool resume,
                                                  Plan& plan,
                                                  std::vector<CaseResult>& before);
  void add(const Plan& plan, const CaseResult& result);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;  ///< null: nothing is kept
};

/// Once the batch is whole and written elsewhere. `path`: of the cases file; may be empty.
void remove_partial_cases(const std::string& path);

}  // namespace palp::lab
