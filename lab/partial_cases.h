#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/core/result.h"
#include "lab/partial_rows.h"
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
  explicit PartialCases(PartialRows rows) : rows_{std::move(rows)} {}
  PartialRows rows_;
};

}  // namespace palp::lab
