#pragma once

#include <string>

#include "review/report_curves.h"
#include "review/time_line.h"

namespace palp::review {

/// A session as a page of HTML that needs nothing besides: opens offline, in any browser. `report`:
/// the JSON document of demo_report(); every number of the page that is no curve comes from there.
/// Curves are thinned to some thousand points.
[[nodiscard]] std::string report_page(const SessionPair& session,
                                      const ReportCurves& curves,
                                      const std::string& report);

}  // namespace palp::review
