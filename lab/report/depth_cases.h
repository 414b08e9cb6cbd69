#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "lab/plan/depth_study.h"

/// The cases of a depth study as a file from which it goes on, or is put together: every number
/// reads back as the same bits.
namespace palp::lab {

/// What the files of one study hold.
struct DepthRows {
  DepthStudy study;
  bool known{};  ///< `study` is that of the rows before, or that which is asked for
  std::vector<DepthCase> cases;
  std::set<std::string> makers;  ///< programs and machines
};

/// With line end.
[[nodiscard]] std::string depth_cases_header();
/// With line end; names its study and who made it, and ends with a check over itself.
[[nodiscard]] std::string depth_case_row(const DepthStudy& study,
                                         const DepthCase& one,
                                         const std::string& made_by);

[[nodiscard]] bool is_depth_cases(std::string_view text);
/// Adds the rows of `text`; those of another study, or not written whole, are refused.
[[nodiscard]] Result<void> read_depth_cases(std::string_view text,
                                            const std::string& name,
                                            DepthRows& rows);

/// Sorts by index. Nothing where they are all cases of the study, each once.
[[nodiscard]] Result<void> check_complete(DepthRows& rows);

/// Over all cases in order.
[[nodiscard]] std::uint64_t digest_of(const std::vector<DepthCase>& cases);

}  // namespace palp::lab
