#pragma once

#include <string>
#include <vector>

#include "common/plot/figure.h"
#include "lab/run/two_port.h"

/// What `palp-lab impedance` found, for people and programs.
namespace palp::lab {

/// Of one law, round trip and frequency.
struct ImpedanceRow {
  std::string coupling;
  double round_trip{};             ///< [s]
  double frequency{};              ///< [Hz]
  Impedance free_air;              ///< [N s/m]
  std::vector<Impedance> tissues;  ///< [N s/m], in the order of the study's
  AbsoluteStability stability;
  bool linear{};  ///< the criterion says something
};

struct ImpedanceStudy {
  std::vector<double> stiffnesses;  ///< [N/m], of the tissues
  std::vector<ImpedanceRow> rows;
};

/// An impedance as two in parallel.
struct ShownParts {
  double spring{};  ///< [N/m]
  double damper{};  ///< [N s/m]
};
[[nodiscard]] ShownParts shown_parts(const Impedance& impedance, double frequency) noexcept;
/// [dB], from free air to the stiffest tissue: what a hand can tell apart at this frequency.
[[nodiscard]] double width_db(const ImpedanceRow& row) noexcept;

[[nodiscard]] std::string impedance_table(const ImpedanceStudy& study);
/// palp.impedance/1
[[nodiscard]] std::string impedance_json(const ImpedanceStudy& study);
[[nodiscard]] std::string impedance_csv(const ImpedanceStudy& study);
/// What is felt of the stiffest tissue and of free air over frequency: a panel for each law, a
/// curve for each round trip.
[[nodiscard]] plot::Figure impedance_figure(const ImpedanceStudy& study);

}  // namespace palp::lab
