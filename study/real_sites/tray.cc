#include "study/real_sites/tray.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/core/conventions.h"
#include "common/core/formatted.h"
#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr double kStep = 4e-3;   // [m], of the grid
constexpr double kApart = 3;     // [radii], of a ball beyond the area that is searched for another
constexpr double kReach = 0.24;  // [m], of a stage's travel, to all sides
constexpr std::uint64_t kDeal = 0x7472617900000000;    // streams apart from those of schedules
constexpr std::uint64_t kOff = 0x7472617900000002;     // off the grid
constexpr std::uint64_t kChoice = 0x7472617900000001;  // which of several places

/// Of each place of the tray.
Result<std::vector<double>> levels_of(const Study& study) {
  if (study.task.places > 0) return study.levels;
  std::vector<double> levels = tissue_levels(study);
  if (levels.size() > patient::kPlacesMax) {
    return fail("a tissue has room for " + std::to_string(patient::kPlacesMax) +
                " places, and the study needs " + std::to_string(levels.size()) +
                ": ask for fewer levels");
  }
  std::size_t more = static_cast<std::size_t>(study.task.intervals) - 1;
  if (!study.task.delays) more = study.task.ranks || study.task.yes_no ? 0 : levels.size() - 2;
  more = std::min(more, patient::kPlacesMax - levels.size());
  levels.insert(levels.end(), more, levels.front());
  return levels;
}

/// Those places of a level that is nearest.
std::vector<Place> places_at(const Tray& tray, double level) {
  const auto off = [level](const TrayPlace& one) { return std::abs(one.level - level); };
  const double least = off(*std::ranges::min_element(tray.places, {}, off));
  std::vector<Place> out;
  for (const TrayPlace& one : tray.places) {
    if (off(one) == least) out.push_back(one.place);
  }
  return out;
}

void add_curve(std::string& csv, const Place& place, const patient::ForceTable& table) {
  for (const patient::ForceRow& row : table.rows()) {
    csv += formatted("%.4f,%.4f,%.9g,%.9g\n",
                     place.x / kMillimetre,
                     place.y / kMillimetre,
                     row.indentation / kMillimetre,
                     row.force);
  }
}

}  // namespace

Result<Tray> make_tray(const Study& study) {
  const auto levels = levels_of(study);
  if (!levels) return tl::unexpected(levels.error());
  const bool searches = study.task.places > 0;
  const double step = searches ? study.search.side + kApart * study.ball->radius : kStep;
  const std::size_t count = levels->size();
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return random_bits(study.seed, kDeal, i); });
  const double half = step * static_cast<double>(side - 1) / 2;
  Tray tray;
  // A ball on a grid would be found by who reads where the stage stands.
  const double off = searches ? study.ball->radius : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto along = [&](std::size_t cell, std::uint64_t axis) {
      const double share = 2 * random_uniform(study.seed, kOff, 2 * i + axis) - 1;
      return step * static_cast<double>(cell) - half + off * share;
    };
    tray.places.push_back({(*levels)[i], {along(order[i] % side, 0), along(order[i] / side, 1)}});
  }
  const double corner = half + off + (searches ? study.search.side : kStep);
  if (corner > kReach) {
    return fail(
        "so many areas as there are depths do not fit a stage's travel: ask for fewer "
        "depths, or a smaller search.side_mm");
  }
  tray.decoys = {{{-corner, -corner}, {-corner, corner}, {corner, -corner}, {corner, corner}}};
  return tray;
}

Place axis_of(const Tray& tray, double level) { return places_at(tray, level).front(); }

std::vector<Place> places_of(const Tray& tray, const Study& study, const TrialAsk& ask) {
  if (study.task.places > 0) {
    const Place axis = axis_of(tray, ask.level);
    return {{axis.x - ask.hidden.x, axis.y - ask.hidden.y}};
  }
  std::vector<Place> out;
  for (const Stimulus& one : stimuli_of(ask, study.task)) {
    const std::vector<Place> places = places_at(tray, one.level);
    // Delays are told apart at different places, and what is compared with lies anywhere.
    const std::size_t which =
        study.task.delays ? out.size() : random_bits(study.seed, kChoice, ask.number);
    out.push_back(places[which % places.size()]);
  }
  return out;
}

std::string tissue_text(const Tray& tray, const Study& study, const LevelCurves& curves) {
  if (study.task.places > 0) {
    std::string words;
    for (const TrayPlace& one : tray.places) {
      words += formatted("ball depth=%.6g radius=%.6g ratio=%.6g at=%.4f,%.4f\n",
                         *depth_of(study, one.level) / kMillimetre,
                         study.ball->radius / kMillimetre,
                         study.ball->ratio,
                         one.place.x / kMillimetre,
                         one.place.y / kMillimetre);
    }
    return words;
  }
  std::string csv = "x_mm,y_mm,d_mm,F_N\n";
  for (const TrayPlace& one : tray.places) add_curve(csv, one.place, curves.at(one.level));
  return csv;
}

}  // namespace palp::study
