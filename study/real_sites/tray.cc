#include "study/real_sites/tray.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr double kStep = 4e-3;                       // [m], of the grid
constexpr double kDecoy = 4e-3;                      // [m], of the decoys beyond the grid
constexpr std::uint64_t kDeal = 0x7472617900000000;  // a stream apart from those of schedules

std::size_t index_of(const std::vector<double>& levels, double level) {
  const auto nearest =
      std::ranges::min_element(levels, {}, [level](double one) { return std::abs(one - level); });
  return static_cast<std::size_t>(nearest - levels.begin());
}

void add_curve(std::string& csv, const Place& place, const patient::ForceTable& table) {
  for (const patient::ForceRow& row : table.rows()) {
    std::array<char, 128> line{};
    std::snprintf(line.data(),
                  line.size(),
                  "%.4f,%.4f,%.9g,%.9g\n",
                  place.x * 1e3,
                  place.y * 1e3,
                  row.indentation * 1e3,
                  row.force);
    csv += line.data();
  }
}

}  // namespace

Tray make_tray(const Study& study) {
  const std::size_t count = study.levels.size() + 1;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return random_bits(study.seed, kDeal, i); });
  const double half = kStep * static_cast<double>(side - 1) / 2;
  const auto place = [&](std::size_t i) -> Place {
    return {kStep * static_cast<double>(order[i] % side) - half,
            kStep * static_cast<double>(order[i] / side) - half};
  };
  Tray tray;
  for (std::size_t i = 0; i + 1 < count; ++i) tray.levels.push_back(place(i));
  tray.reference = place(count - 1);
  const double corner = half + kDecoy;
  tray.decoys = {{{-corner, -corner}, {-corner, corner}, {corner, -corner}, {corner, corner}}};
  return tray;
}

std::vector<Place> places_of(const Tray& tray, const Study& study, const TrialAsk& ask) {
  if (study.task.yes_no) return {tray.levels[index_of(study.levels, ask.level)]};
  std::vector<Place> places(static_cast<std::size_t>(study.task.intervals), tray.reference);
  places[ask.stronger] = tray.levels[index_of(study.levels, ask.level)];
  return places;
}

std::string tray_csv(const Tray& tray, const Study& study, const LevelCurves& curves) {
  std::string csv = "x_mm,y_mm,d_mm,F_N\n";
  add_curve(csv, tray.reference, curves.at(0));
  for (std::size_t i = 0; i < study.levels.size(); ++i) {
    add_curve(csv, tray.levels[i], curves.at(study.levels[i]));
  }
  return csv;
}

}  // namespace palp::study
