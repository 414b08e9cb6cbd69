#include <cstdio>

#include "lab/plan/locate_study.h"
#include "lab/report/locate_figures.h"

namespace palp::lab {
namespace {

/// A line of the table.
std::string text_of(const LocateStudy& study, const std::string& name, const LocateFigures& f) {
  char line[240];
  std::snprintf(line,
                sizeof line,
                "%-16s %4zu %5.1f%%",
                name.c_str(),
                f.count,
                100 * share_or_zero(f.found, f.count));
  std::string out = line;
  if (f.found == 0) return out + '\n';
  out += "      ";
  for (std::size_t i = 0; i < kLocated; ++i) {
    if (tells(study, i)) {
      std::snprintf(line, sizeof line, " %6.1f", 100 * share_or_zero(f.inside[i], f.found));
      out += line;
    } else {
      out += "      -";
    }
  }
  out += "   ";
  for (std::size_t i = 0; i + 1 < kLocated; ++i) {
    std::snprintf(line, sizeof line, " %6.2f", f.rmse[i] / unit_of(i));
    out += line;
  }
  out += "   ";
  for (std::size_t i = 0; i + 1 < kLocated; ++i) {
    if (f.bounds[i] > 0) {
      std::snprintf(line, sizeof line, " %6.2f", f.rmse[i] / f.bounds[i]);
      out += line;
    } else {
      out += "      -";
    }
  }
  return out + '\n';
}

std::string worlds_text(const std::vector<LocateCase>& cases) {
  std::string out = "kind              n  confidently wrong  warned  plain called an inclusion\n";
  for (const LocateWorlds& one : worlds_of(cases)) {
    char line[160];
    std::snprintf(line,
                  sizeof line,
                  "%-12s %6zu %17.1f%% %6.1f%% %26zu\n",
                  one.name.c_str(),
                  one.count,
                  100 * share_or_zero(one.wrong, one.count),
                  100 * share_or_zero(one.warned, one.count),
                  one.alarms);
    out += line;
  }
  return out;
}

}  // namespace

std::string locate_table(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  std::string out =
      "balls               n  found  coverage % x     y depth radius ratio  rms mm x     y depth "
      "radius  over bound x    y depth radius\n";
  out += text_of(study, "all", figures_of_all(cases));
  for (const LocateCell& cell : cells_of(study, cases)) {
    out += text_of(study, cell.name, cell.figures);
  }
  for (const LocateRow& row : rows_of(study, cases)) out += text_of(study, row.name, row.figures);
  if (study.mismatch) return out + worlds_text(cases);
  const LocateAlarms told = alarms(cases);
  char line[240];
  std::snprintf(line,
                sizeof line,
                "right (x, y, depth within 1 mm, the radius in its interval) %zu of %zu balls\n"
                "false alarms %.2f %% of %zu plain phantoms\nmodel doubted %.2f %% of all\n",
                right_of(cases),
                balls_of(cases),
                100 * share_or_zero(told.found, told.plain),
                told.plain,
                100 * share_or_zero(told.model, told.all));
  out += line;
  if (study.rule) {
    std::snprintf(line,
                  sizeof line,
                  "touches, median of all balls, until known to 1 mm: %.1f, until right to 1 mm "
                  "beside the axis: %.1f\n",
                  touches_of(cases, &Searched::known),
                  touches_of(cases, &Searched::near));
    out += line;
  }
  if (study.script.empty()) return out;
  std::snprintf(line, sizeof line, "strokes, median of the balls found: %.0f\n", strokes_of(cases));
  return out + line;
}

std::string locate_csv(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  std::string out =
      "index,kind,inclusion,found,doubts,ratio,scale,log_evidence,balls_worth,worst_curve,"
      "worst_deviation";
  for (const char* name : kLocatedNames) {
    for (const char* what : {"true_", "median_", "low_", "high_", "crb_"}) {
      out.append(",").append(what).append(name);
    }
  }
  out += '\n';
  for (const LocateCase& one : cases) {
    char line[200];
    std::snprintf(line,
                  sizeof line,
                  "%u,%s,%d,%d,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g",
                  one.index,
                  std::string{study.mismatch ? to_string(one.kind) : "assumed"}.c_str(),
                  one.inclusion ? 1 : 0,
                  one.found ? 1 : 0,
                  one.doubts,
                  one.ratio,
                  one.scale,
                  one.log_evidence,
                  one.balls_worth,
                  one.worst_curve,
                  one.worst_deviation);
    out += line;
    for (std::size_t i = 0; i < kLocated; ++i) {
      const Located& told = one.coordinates[i];
      for (const double value : {told.truth, told.median, told.low, told.high, told.bound}) {
        std::snprintf(line, sizeof line, ",%.9g", value / unit_of(i));
        out += line;
      }
    }
    out += '\n';
  }
  return out;
}

}  // namespace palp::lab
