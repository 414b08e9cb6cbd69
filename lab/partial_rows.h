#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "common/core/result.h"

namespace palp::lab {

/// The rows of a run of many cases as they come, in `FILE.partial` beside the file that is to be,
/// so that an interrupted run is taken up again. Thread: one at a time.
class PartialRows {
 public:
  /// `path`: of the file that is to be; empty, or a pipe: nothing is kept. Without `resume`, what
  /// is there is written over.
  [[nodiscard]] static Result<PartialRows> open(const std::string& path, bool resume);
  /// The header and the rows that an interrupted run left, without those that it half wrote.
  [[nodiscard]] const std::string& before() const { return before_; }
  /// Where they are.
  [[nodiscard]] const std::string& file() const { return name_; }
  /// Once before_ is found to fit: what is added from now on stands below it. `header` has a line
  /// end.
  [[nodiscard]] Result<void> begin(const std::string& header);
  /// `row` has a line end. One that the disk does not take is made again.
  void add(const std::string& row);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
  };
  std::string name_;  ///< empty: nothing is kept
  std::string before_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Once the run is whole and written elsewhere. `path`: as of open().
void remove_partial_rows(const std::string& path);

}  // namespace palp::lab
