#include "common/message/map_text.h"

#include "common/core/conventions.h"
#include "common/core/formatted.h"

namespace palp {
namespace {

double mm(double metres) noexcept { return metres / kMillimetre; }

std::string assumption(const MapReport& report) {
  return formatted("if the tissue's stiffness varies by %.3g %% from place to place at most",
                   100 * report.place_spread);
}

std::string found_sentence(const MapReport& report) {
  return "One round inclusion, " + assumption(report) + ": " +
         formatted("at x %.1f mm (%.1f to %.1f), y %.1f mm (%.1f to %.1f), ",
                   mm(report.x.median),
                   mm(report.x.low),
                   mm(report.x.high),
                   mm(report.y.median),
                   mm(report.y.low),
                   mm(report.y.high)) +
         formatted("its top %.1f mm deep (%.1f to %.1f), radius %.1f mm (%.1f to %.1f).",
                   mm(report.depth.median),
                   mm(report.depth.low),
                   mm(report.depth.high),
                   mm(report.radius.median),
                   mm(report.radius.low),
                   mm(report.radius.high));
}

std::string next_text(const MapReport& report) {
  return formatted("%.0f,%.0f", mm(report.next.x), mm(report.next.y));
}

}  // namespace

std::string map_sentence(const MapReport& report) {
  if (report.number == 0) return "Taps at three places or more say where an inclusion lies.";
  std::string text = report.verdict == DepthVerdict::Found
                         ? found_sentence(report)
                         : "No inclusion found, " + assumption(report) + ".";
  for (std::size_t i = 0; i < kMapDoubts; ++i) {
    const auto doubt = static_cast<MapDoubt>(i);
    if ((report.doubts & doubts_of(doubt)) == 0) continue;
    text.append(" Not trusted: ").append(reason_of(doubt)).append("; ");
    text.append(remedy_of(doubt)).append(".");
  }
  if (report.stop == MapStop::GoOn) {
    text.append(" The next tap tells most at ").append(next_text(report)).append(" mm.");
  } else {
    text.append(" Enough taps: ").append(to_string(report.stop)).append(".");
  }
  return text;
}

std::string map_line(const MapReport& report) {
  std::string text;
  if (report.verdict == DepthVerdict::Found) {
    text = formatted("inclusion at %.1f,%.1f: top %.1f mm deep (%.1f to %.1f), ",
                     mm(report.x.median),
                     mm(report.y.median),
                     mm(report.depth.median),
                     mm(report.depth.low),
                     mm(report.depth.high)) +
           formatted("radius %.1f (%.1f to %.1f)",
                     mm(report.radius.median),
                     mm(report.radius.low),
                     mm(report.radius.high));
  } else {
    text = formatted("no inclusion found at %u places", report.places);
  }
  if (!report.trusted()) text += " NOT TRUSTED";
  return text + (report.stop == MapStop::GoOn ? ", next tap " + next_text(report) : ", enough");
}

std::string map_brief(const MapReport& report) {
  std::string text = report.verdict == DepthVerdict::Found ? formatted("%.0f,%.0f: depth %.1f mm",
                                                                       mm(report.x.median),
                                                                       mm(report.y.median),
                                                                       mm(report.depth.median))
                                                           : "no inclusion";
  return text + (report.trusted() ? "" : "?");
}

}  // namespace palp
