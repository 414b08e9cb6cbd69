#include "lab/impedance_command.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/config/exit_code.h"
#include "common/config/report.h"
#include "common/core/conventions.h"
#include "lab/number_list.h"
#include "lab/report/impedance_report.h"

namespace palp::lab {
namespace {

using config::ExitCode;
using config::ExitStatus;

/// All that is to be measured, without an answer yet.
Result<ImpedanceStudy> study_of(const ImpedanceFlags& flags) {
  const auto round_trips = parse_numbers("--rtt-ms", flags.round_trips_ms, 0, 5000);
  if (!round_trips) return tl::unexpected(round_trips.error());
  const auto frequencies = parse_numbers("--frequency-hz", flags.frequencies_hz, 0.2, 50);
  if (!frequencies) return tl::unexpected(frequencies.error());
  const auto stiffnesses = parse_numbers("--stiffness", flags.stiffnesses, 1, 20'000);
  if (!stiffnesses) return tl::unexpected(stiffnesses.error());
  ImpedanceStudy study{.stiffnesses = *stiffnesses, .rows = {}};
  std::ranges::sort(study.stiffnesses);
  for (const std::string_view name : coupling::kCouplingNames) {
    if (!flags.coupling.empty() && flags.coupling != name) continue;
    for (const double round_trip : *round_trips) {
      for (const double frequency : *frequencies) {
        study.rows.push_back({.coupling = std::string{name},
                              .round_trip = 1e-3 * round_trip,
                              .frequency = frequency,
                              .free_air = {},
                              .tissues = {},
                              .stability = {},
                              .linear = is_linear(name)});
      }
    }
  }
  return study;
}

void measure(ImpedanceRow& row, const std::vector<double>& stiffnesses, double amplitude) {
  TwoPortSetup setup{
      .round_trip = row.round_trip, .frequency = row.frequency, .amplitude = amplitude};
  setup.coupling.name = row.coupling;
  row.free_air = transmitted_impedance(setup, 0);
  for (const double stiffness : stiffnesses) {
    row.tissues.push_back(transmitted_impedance(setup, stiffness));
  }
  if (row.linear) row.stability = absolute_stability(hybrid_matrix(setup));
}

}  // namespace

void declare_impedance(config::CommandLine& line, ImpedanceFlags& flags) {
  const std::vector<std::string> names{coupling::kCouplingNames.begin(),
                                       coupling::kCouplingNames.end()};
  line.choice("--coupling", flags.coupling, names, "one law; without it all");
  line.text("--rtt-ms", flags.round_trips_ms, "LIST", "round trips [ms], 0 to 5000");
  line.text("--frequency-hz", flags.frequencies_hz, "LIST", "frequencies [Hz], 0.2 to 50");
  line.text("--stiffness", flags.stiffnesses, "LIST", "of the tissues [N/m], 1 to 20000");
  line.number("--amplitude-mm",
              flags.amplitude_mm,
              {.min = 0.01, .max = 2, .unit = "mm"},
              "of the hand's swing, 3 mm deep");
  line.whole("--cores", flags.cores, {.min = 1, .max = 256}, "threads; else one a processor");
  line.report(flags.report, "palp.impedance/1");
  line.output("--csv", flags.csv, "a line for each law, round trip, frequency and tissue");
  plot::declare_picture(line, flags.picture, "the stiffest tissue and free air over frequency");
}

ExitStatus run_impedance(const ImpedanceFlags& flags, const Machine& machine) {
  auto study = study_of(flags);
  if (!study) return refusal(study.error());
  auto can = config::can_write_files({flags.report, flags.csv});
  if (can) can = plot::can_write_picture(flags.picture);
  if (!can) return {ExitCode::CannotOpen, "palp-lab: " + can.error().text};
  machine.for_each_index(
      study->rows.size(), flags.cores.value_or(machine.processors), [&](std::size_t i) {
        measure(study->rows[i], study->stiffnesses, flags.amplitude_mm * kMillimetre);
      });
  for (const auto& [path, text] : {std::pair{flags.report, impedance_json(*study)},
                                   std::pair{flags.csv, impedance_csv(*study)}}) {
    if (path.empty()) continue;
    if (const auto written = config::write_whole_file(path, text); !written) {
      return {ExitCode::CannotOpen, "palp-lab: " + written.error().text};
    }
  }
  if (const auto drawn = plot::write_picture(impedance_figure(*study), flags.picture); !drawn) {
    return {ExitCode::CannotOpen, "palp-lab: " + drawn.error().text};
  }
  return {ExitCode::Done, impedance_table(*study)};
}

}  // namespace palp::lab
