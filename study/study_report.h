#pragma once

#include <string>
#include <vector>

#include "common/plot/figure.h"
#include "study/data_fit.h"

/// A study's report: one page of HTML that needs nothing besides, with its figures inside. Pure.
namespace palp::study {

/// What the page says; `names` of the conditions are codes unless unblinded.
struct ReportParts {
  std::string standing{};         ///< confirmatory or not, and why
  std::string preregistration{};  ///< as it was registered
  std::vector<std::string> names{};
  bool blind{true};    ///< `names` are codes
  std::string kind{};  ///< who answered
};

/// Each participant's JND by condition with 95 % intervals, their geometric mean before them.
[[nodiscard]] plot::Figure jnd_figure(const Study& study,
                                      const StudyFit& fit,
                                      const std::vector<std::string>& names);

/// Shares of answers by level over all participants, with Wilson's 95 % intervals, beside the
/// function of the mean observer: a panel for each condition.
[[nodiscard]] plot::Figure answers_figure(const Study& study,
                                          const StudyFit& fit,
                                          const std::vector<std::string>& names);

[[nodiscard]] std::string report_html(const Study& study,
                                      const StudyFit& fit,
                                      const ReportParts& parts);

}  // namespace palp::study
