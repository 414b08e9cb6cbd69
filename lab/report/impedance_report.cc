#include "lab/report/impedance_report.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "common/config/json.h"
#include "common/config/number.h"
#include "common/core/number_text.h"

namespace palp::lab {
namespace {

using config::Json;

double decibel(double ratio) { return 20 * std::log10(ratio); }

/// The rows of one law, round trip by round trip; each a curve of `value`.
template <class Value>
std::vector<plot::Curve> curves_of(const ImpedanceStudy& study,
                                   const std::string& coupling,
                                   const Value& value) {
  std::vector<plot::Curve> curves;
  double round_trip = -1;
  for (const ImpedanceRow& row : study.rows) {
    if (row.coupling != coupling) continue;
    if (std::exchange(round_trip, row.round_trip) != row.round_trip) {
      curves.push_back({.name = number_text("round trip ", row.round_trip * 1e3, 0, " ms"),
                        .colour = static_cast<int>(curves.size() % plot::kCurveColours)});
    }
    curves.back().x.push_back(row.frequency);
    curves.back().y.push_back(value(row));
  }
  return curves;
}

/// Of one law: what is felt of the stiffest tissue, of the air, and what the tissue itself has.
plot::Panel panel_of(const ImpedanceStudy& study, const std::string& coupling, bool first) {
  plot::Panel panel{
      .axes = {.title = coupling, .y_name = "impedance [dB re 1 N s/m]", .x_logarithmic = true}};
  panel.curves = curves_of(study, coupling, [](const ImpedanceRow& row) {
    return decibel(std::abs(row.tissues.back()));
  });
  plot::Curve truth{.name = "tissue itself", .colour = plot::kGrey, .opacity = 0.6};
  truth.x = panel.curves.front().x;
  for (const double frequency : truth.x) {
    truth.y.push_back(decibel(study.stiffnesses.back() / (2 * std::numbers::pi * frequency)));
  }
  panel.curves.push_back(std::move(truth));
  auto air = curves_of(
      study, coupling, [](const ImpedanceRow& row) { return decibel(std::abs(row.free_air)); });
  for (plot::Curve& curve : air) {
    curve.name.clear();
    curve.mark = plot::Mark::Dashes;
    panel.curves.push_back(std::move(curve));
  }
  if (!first) {
    for (plot::Curve& curve : panel.curves) curve.name.clear();
  }
  return panel;
}

std::string right(std::string text, std::size_t width) {
  if (text.size() < width) text.insert(0, width - text.size(), ' ');
  return text;
}
std::string cell(double value, int digits, std::size_t width) {
  return right(std::isfinite(value) ? number_text("", value, digits, "") : "-", width);
}

std::string stability_cell(const ImpedanceRow& row) {
  if (!row.linear) return right("not linear", 12);
  return right(row.stability.holds() ? "yes" : "no", 4) + cell(row.stability.margin, 2, 8);
}

}  // namespace

ShownParts shown_parts(const Impedance& impedance, double frequency) noexcept {
  const double rate = 2 * std::numbers::pi * frequency;
  return {.spring = -rate * impedance.imag(), .damper = impedance.real()};
}

double width_db(const ImpedanceRow& row) noexcept {
  return decibel(std::abs(row.tissues.back()) / std::abs(row.free_air));
}

std::string impedance_table(const ImpedanceStudy& study) {
  std::string text = "coupling  round trip  frequency   free air";
  for (const double stiffness : study.stiffnesses) {
    text += right(number_text("", stiffness, 0, " N/m felt as"), 20);
  }
  text += "   width  absolutely stable\n                  ms         Hz      N s/m";
  for (std::size_t i = 0; i < study.stiffnesses.size(); ++i) text += right("N/m, N s/m", 20);
  text += "      dB       (margin)\n";
  for (const ImpedanceRow& row : study.rows) {
    std::string name = row.coupling;
    name.resize(8, ' ');
    text += name + cell(row.round_trip * 1e3, 0, 12) + cell(row.frequency, 1, 11) +
            cell(std::abs(row.free_air), 2, 11);
    for (const Impedance& tissue : row.tissues) {
      const ShownParts shown = shown_parts(tissue, row.frequency);
      text += cell(shown.spring, 1, 12) + cell(shown.damper, 1, 8);
    }
    text += cell(width_db(row), 1, 8) + "   " + stability_cell(row) + '\n';
  }
  return text;
}

std::string impedance_json(const ImpedanceStudy& study) {
  Json json;
  json["schema"] = "palp.impedance/1";
  json["rows"] = Json::array();
  for (const ImpedanceRow& row : study.rows) {
    Json one{{"coupling", row.coupling},
             {"rtt_ms", row.round_trip * 1e3},
             {"frequency_hz", row.frequency},
             {"free_air_re_n_s_per_m", row.free_air.real()},
             {"free_air_im_n_s_per_m", row.free_air.imag()},
             {"width_db", width_db(row)}};
    one["tissues"] = Json::array();
    for (std::size_t i = 0; i < row.tissues.size(); ++i) {
      const ShownParts shown = shown_parts(row.tissues[i], row.frequency);
      one["tissues"].push_back({{"stiffness_n_per_m", study.stiffnesses[i]},
                                {"re_n_s_per_m", row.tissues[i].real()},
                                {"im_n_s_per_m", row.tissues[i].imag()},
                                {"shown_n_per_m", shown.spring},
                                {"shown_n_s_per_m", shown.damper}});
    }
    // What says nothing of a law that is not linear is null.
    const auto told = [&](double value) { return row.linear ? Json(value) : Json(nullptr); };
    one["llewellyn"] = {
        {"re_h11_n_s_per_m", told(row.stability.hand)},
        {"re_h22_m_per_n_s", told(row.stability.tissue)},
        {"margin", told(row.stability.margin)},
        {"absolutely_stable", row.linear ? Json(row.stability.holds()) : Json(nullptr)}};
    json["rows"].push_back(one);
  }
  return json.dump(2) + '\n';
}

std::string impedance_csv(const ImpedanceStudy& study) {
  std::string text =
      "coupling,rtt_ms,frequency_hz,stiffness_n_per_m,re_n_s_per_m,im_n_s_per_m,shown_n_per_m,"
      "shown_n_s_per_m\n";
  const auto line = [&](const ImpedanceRow& row, double stiffness, const Impedance& impedance) {
    const ShownParts shown = shown_parts(impedance, row.frequency);
    text += row.coupling;
    for (const double value : {row.round_trip * 1e3,
                               row.frequency,
                               stiffness,
                               impedance.real(),
                               impedance.imag(),
                               shown.spring,
                               shown.damper}) {
      text += ',' + config::number_text(value);
    }
    text += '\n';
  };
  for (const ImpedanceRow& row : study.rows) {
    line(row, 0, row.free_air);
    for (std::size_t i = 0; i < row.tissues.size(); ++i) {
      line(row, study.stiffnesses[i], row.tissues[i]);
    }
  }
  return text;
}

plot::Figure impedance_figure(const ImpedanceStudy& study) {
  plot::Figure figure{.title = number_text(
                          "Felt of ", study.stiffnesses.back(), 0, " N/m (lines), of air (dashes)"),
                      .panels = {}};
  std::string last;
  for (const ImpedanceRow& row : study.rows) {
    if (std::exchange(last, row.coupling) == row.coupling) continue;
    figure.panels.push_back(panel_of(study, row.coupling, figure.panels.empty()));
  }
  figure.panels.back().axes.x_name = "frequency [Hz]";
  return figure;
}

}  // namespace palp::lab
