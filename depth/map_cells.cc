#include "depth/map_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace palp::depth {
namespace {

constexpr double kScanStep = 4e-3;  // [m], of the places where a ball is first looked for
constexpr std::size_t kScanDepths = 6;
constexpr std::size_t kScanRadii = 3;
constexpr double kScanOffset = 0.5e-3;     // [m]
constexpr std::size_t kScanOffsets = 160;  // 80 mm, beyond which a ball has no effect
constexpr double kScanRatio = 0.6;         // [-], of the logarithm's range
constexpr double kModeApart = 6e-3;        // [m]
constexpr double kModeReach = 42;          // [-], log-likelihood below the best, roughly: no mode
constexpr std::size_t kFirstRadii = 3;     // cells to begin with
constexpr std::size_t kFirstRatios = 2;
constexpr std::size_t kCellsMax = 40;
constexpr double kFineReach = 0.7;  // [-], standard deviations to a cell's edge: fine enough
constexpr double kLight = 4e-3;     // [-], share of all: not worth halving
constexpr int kClimbsFirst = 12;
constexpr int kClimbsCells = 5;
constexpr int kClimbsLater = 3;
constexpr double kPlaceStep = 6e-3;     // [m], longest of a climb
constexpr double kDepthStep = 0.4;      // [-], of the logarithm
constexpr double kPlaceSpread = 15e-3;  // [m], of a place that no touch tells
constexpr double kClimbed = 0.02;       // [-], of the logarithm: no higher, and it is the top
constexpr double kInflation = 1.15;     // [-], of what is drawn from

class CellMaker {
 public:
  CellMaker(const MapLikelihood& likelihood, const BallField& field, const BallPrior& prior)
      : likelihood_{likelihood}, field_{field}, prior_{prior} {}

  std::vector<BallCell> run() {
    for (const BallCell& start : starts()) add_family(start);
    halve();
    return std::move(cells_);
  }

 private:
  /// A ball of some depth and radius, looked for everywhere.
  struct Kind {
    std::vector<double> told;  ///< [-], ln of the force over plain tissue, by steps of the offset
    double log_depth{};
    double radius{};
  };
  /// Where an offset lies in that table.
  struct Step {
    std::size_t first{};
    double share{};  ///< [-], of the one after
  };
  [[nodiscard]] std::vector<Kind> kinds_of_ball(double log_ratio) const {
    std::vector<Kind> kinds;
    for (std::size_t i = 0; i < kScanDepths; ++i) {
      for (std::size_t j = 0; j < kScanRadii; ++j) {
        const double log_depth =
            prior_.log_depth_low() + (prior_.log_depth_high() - prior_.log_depth_low()) *
                                         (static_cast<double>(i) + 0.5) / kScanDepths;
        const double radius = prior_.given().ball.radius_min +
                              prior_.radius_width() * (static_cast<double>(j) + 0.5) / kScanRadii;
        Kind kind{.told = {}, .log_depth = log_depth, .radius = radius};
        const auto ball = field_.at(log_depth, radius, effect_of(std::exp(log_ratio)));
        for (std::size_t step = 0; step <= kScanOffsets; ++step) {
          const double offset = static_cast<double>(step) * kScanOffset;
          kind.told.push_back(std::log(ball.ratio(offset)[kMiddleNode]));
        }
        kinds.push_back(std::move(kind));
      }
    }
    return kinds;
  }

  /// Where to begin: the best places on a grid, by each place's excess alone.
  [[nodiscard]] std::vector<BallCell> starts() const {
    const auto& places = likelihood_.places();
    double left = places.front().place.x;
    double right = left;
    double low = places.front().place.y;
    double high = low;
    for (const PlaceData& touched : places) {
      left = std::min(left, touched.place.x);
      right = std::max(right, touched.place.x);
      low = std::min(low, touched.place.y);
      high = std::max(high, touched.place.y);
    }
    struct Start {
      double value{};
      MapBall ball;
    };
    std::vector<Start> found;
    const auto along = [&](double from, double to) {
      return 1 + static_cast<int>(std::ceil((to - from + 2 * prior_.given().reach) / kScanStep));
    };
    const int columns = along(left, right);
    const int rows = along(low, high);
    const double log_ratio = prior_.log_ratio_low() + kScanRatio * prior_.log_ratio_width();
    const std::vector<Kind> kinds = kinds_of_ball(log_ratio);
    for (int column = 0; column < columns; ++column) {
      for (int row = 0; row < rows; ++row) {
        const Place place{0.5 * (left + right) + (column - 0.5 * (columns - 1)) * kScanStep,
                          0.5 * (low + high) + (row - 0.5 * (rows - 1)) * kScanStep};
        if (prior_.covering(place) == 0) continue;
        const std::vector<Step> steps = steps_from(place);
        Start best{-std::numeric_limits<double>::infinity(), {}};
        for (const Kind& kind : kinds) {
          const double value = rough(kind, steps);
          if (value > best.value) best = {value, {place, kind.log_depth, kind.radius, log_ratio}};
        }
        found.push_back(best);
      }
    }
    std::sort(found.begin(), found.end(), [](const Start& a, const Start& b) {
      return a.value > b.value;
    });
    std::vector<BallCell> out;
    for (const Start& start : found) {
      if (out.size() == kModesMax || start.value < found.front().value - kModeReach) break;
      const bool near = std::any_of(out.begin(), out.end(), [&](const BallCell& cell) {
        return distance({cell.best[0], cell.best[1]}, start.ball.place) < kModeApart;
      });
      if (near) continue;
      BallCell cell;
      cell.radius = start.ball.radius;
      cell.log_ratio = start.ball.log_ratio;
      cell.best = {start.ball.place.x, start.ball.place.y, start.ball.log_depth};
      cell.mode = out.size();
      out.push_back(cell);
    }
    return out;
  }

  [[nodiscard]] std::vector<Step> steps_from(const Place& axis) const {
    std::vector<Step> steps;
    steps.reserve(likelihood_.places().size());
    for (const PlaceData& touched : likelihood_.places()) {
      constexpr double kLast = kScanOffsets - 1;
      const double at = distance(touched.place, axis) / kScanOffset;
      const auto first = static_cast<std::size_t>(std::min(at, kLast));
      steps.push_back({first, std::min(at - static_cast<double>(first), 1.0)});
    }
    return steps;
  }

  /// Log-likelihood of the places' excess, one number each, over a common tissue.
  [[nodiscard]] double rough(const Kind& kind, const std::vector<Step>& steps) const noexcept {
    double weights = 0;
    double sum = 0;
    double squares = 0;
    const auto& excess = likelihood_.excess();
    for (std::size_t i = 0; i < excess.size(); ++i) {
      const double* told = &kind.told[steps[i].first];
      const double left = excess[i].value - told[0] - steps[i].share * (told[1] - told[0]);
      const double weight = 1 / (excess[i].stddev * excess[i].stddev);
      weights += weight;
      sum += weight * left;
      squares += weight * left * left;
    }
    return -0.5 * (squares - sum * sum / (weights + 100));
  }

  [[nodiscard]] static MapBall ball_of(const BallCell& cell, const Vector3& at) noexcept {
    return {{at[0], at[1]}, at[2], cell.radius, cell.log_ratio};
  }

  /// Gauss's steps in place and depth at the cell's radius and ratio.
  void climb(BallCell& cell, int steps) const {
    cell.best[2] =
        std::clamp(cell.best[2], prior_.log_depth_low(), prior_.log_deepest(cell.radius));
    MapLikelihood::Local local = likelihood_.around(ball_of(cell, cell.best));
    for (int step = 0;; ++step) {
      measure(local, cell);
      if (step == steps) return;
      Vector3 move{};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          move[i] += cell.covariance[i][j] * (local.slope[j] + (j == 2 ? 1.0 : 0.0));
        }
      }
      const double far =
          std::max(std::hypot(move[0], move[1]) / kPlaceStep, std::abs(move[2]) / kDepthStep);
      double share = far > 1 ? 1 / far : 1;
      bool better = false;
      for (int halving = 0; halving < 3 && !better; ++halving, share *= 0.3) {
        Vector3 next = cell.best;
        for (std::size_t i = 0; i < 3; ++i) next[i] += share * move[i];
        next[2] = std::clamp(next[2], prior_.log_depth_low(), prior_.log_deepest(cell.radius));
        // Nobody looks beyond the prior's end.
        if (prior_.covering({next[0], next[1]}) == 0) continue;
        const MapLikelihood::Local there = likelihood_.around(ball_of(cell, next));
        if (there.value + next[2] <= local.value + cell.best[2]) continue;
        better = there.value + next[2] > local.value + cell.best[2] + kClimbed;
        cell.best = next;
        local = there;
        if (!better) {
          measure(local, cell);
          return;
        }
      }
      if (!better) return;
    }
  }

  void measure(const MapLikelihood::Local& local, BallCell& cell) const noexcept {
    const double range = std::max(prior_.log_depth_high() - prior_.log_depth_low(), 1e-3);
    Matrix3 information{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) information[i][j] = local.information[i][j];
    }
    information[0][0] += 1 / (kPlaceSpread * kPlaceSpread);
    information[1][1] += 1 / (kPlaceSpread * kPlaceSpread);
    information[2][2] += 12 / (range * range);
    const Inverse3 solved = inverse(information);
    cell.covariance = solved.matrix;
    cell.value = local.value + cell.best[2];
    cell.volume = 1.5 * std::log(2 * std::numbers::pi) - 0.5 * std::log(solved.determinant);
    cell.root = {};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = cell.covariance[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= cell.root[i][k] * cell.root[j][k];
        cell.root[i][j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / cell.root[j][j];
      }
    }
    const auto along = [&](std::size_t coordinate, Vector3& moves) {
      double rest = local.information[coordinate][coordinate];
      for (std::size_t i = 0; i < 3; ++i) {
        moves[i] = 0;
        for (std::size_t j = 0; j < 3; ++j) {
          moves[i] -= cell.covariance[i][j] * local.information[coordinate][j];
        }
        rest += moves[i] * local.information[coordinate][i];
      }
      return std::sqrt(std::max(0.0, rest));
    };
    cell.radius_reach = 0.5 * cell.radius_width * along(3, cell.by_radius);
    cell.ratio_reach = 0.5 * cell.ratio_width * along(4, cell.by_ratio);
    cell.mass = cell.value + cell.volume + std::log(cell.radius_width * cell.ratio_width);
  }

  /// Cells over all of radius and ratio round one place.
  void add_family(const BallCell& start) {
    BallCell best = start;
    climb(best, kClimbsFirst);
    for (const BallCell& other : cells_) {
      const bool same =
          distance({other.best[0], other.best[1]}, {best.best[0], best.best[1]}) < 1e-3;
      if (same && other.mode != start.mode) return;
    }
    const std::size_t wide = prior_.radius_width() > kNoWidth ? kFirstRadii : 1;
    const std::size_t hard = prior_.log_ratio_width() > kNoWidth ? kFirstRatios : 1;
    for (std::size_t j = 0; j < wide; ++j) {
      for (std::size_t k = 0; k < hard; ++k) {
        BallCell cell = best;
        cell.radius_width = prior_.radius_width() / static_cast<double>(wide);
        cell.ratio_width = prior_.log_ratio_width() / static_cast<double>(hard);
        cell.radius =
            prior_.given().ball.radius_min + (static_cast<double>(j) + 0.5) * cell.radius_width;
        cell.log_ratio = prior_.log_ratio_low() + (static_cast<double>(k) + 0.5) * cell.ratio_width;
        follow(best, cell);
        climb(cell, kClimbsCells);
        cells_.push_back(cell);
      }
    }
  }

  /// The best of another cell, as it moves with radius and ratio.
  static void follow(const BallCell& from, BallCell& cell) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      cell.best[i] = from.best[i] + from.by_radius[i] * (cell.radius - from.radius) +
                     from.by_ratio[i] * (cell.log_ratio - from.log_ratio);
    }
    const double off = std::hypot(cell.best[0] - from.best[0], cell.best[1] - from.best[1]);
    if (off < kPlaceStep) return;
    cell.best[0] = from.best[0];
    cell.best[1] = from.best[1];
  }

  [[nodiscard]] double total_mass() const noexcept {
    double most = -std::numeric_limits<double>::infinity();
    for (const BallCell& cell : cells_) most = std::max(most, cell.mass);
    double sum = 0;
    for (const BallCell& cell : cells_) sum += std::exp(cell.mass - most);
    return most + std::log(sum);
  }

  /// The heaviest cell that is not fine goes in two.
  void halve() {
    while (cells_.size() < kCellsMax) {
      const double total = total_mass();
      std::optional<std::size_t> heaviest;
      double most = 0;
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        const BallCell& cell = cells_[i];
        const double reach = std::max(cell.radius_reach, cell.ratio_reach);
        // The edge of a coarse cell may be likelier than its middle.
        const double share = std::exp(cell.mass - total + std::min(0.5 * reach * reach, 8.0));
        if (reach < kFineReach || share < kLight || share * reach < most) continue;
        most = share * reach;
        heaviest = i;
      }
      if (!heaviest) return;
      const BallCell whole = cells_[*heaviest];
      const bool wide = whole.radius_reach > whole.ratio_reach;
      for (int half = 0; half < 2; ++half) {
        BallCell part = whole;
        (wide ? part.radius_width : part.ratio_width) *= 0.5;
        (wide ? part.radius : part.log_ratio) +=
            (half - 0.5) * (wide ? part.radius_width : part.ratio_width);
        follow(whole, part);
        climb(part, kClimbsLater);
        if (half == 0) {
          cells_[*heaviest] = part;
        } else {
          cells_.push_back(part);
        }
      }
    }
  }

  const MapLikelihood& likelihood_;
  const BallField& field_;
  const BallPrior& prior_;
  std::vector<BallCell> cells_;
};

}  // namespace

Vector3 BallCell::middle(double at_radius, double at_log_ratio) const noexcept {
  Vector3 out = best;
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] += by_radius[i] * (at_radius - radius) + by_ratio[i] * (at_log_ratio - log_ratio);
  }
  return out;
}

bool BallCell::holds(const MapBall& ball) const noexcept {
  constexpr double kHalf = 0.5 * (1 + 1e-12);
  return std::abs(ball.radius - radius) <= kHalf * radius_width &&
         std::abs(ball.log_ratio - log_ratio) <= kHalf * ratio_width;
}

MapBall BallCell::draw(double at_radius,
                       double at_log_ratio,
                       const Vector3& normal,
                       double chi_square) const noexcept {
  const double stretch = kInflation * std::sqrt(4 / std::max(chi_square, 1e-3));
  Vector3 at = middle(at_radius, at_log_ratio);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) at[i] += stretch * root[i][j] * normal[j];
  }
  return {{at[0], at[1]}, at[2], at_radius, at_log_ratio};
}

double BallCell::log_density(const MapBall& ball) const noexcept {
  const Vector3 from = middle(ball.radius, ball.log_ratio);
  const Vector3 off{ball.place.x - from[0], ball.place.y - from[1], ball.log_depth - from[2]};
  Vector3 z{};
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double rest = off[i];
    for (std::size_t j = 0; j < i; ++j) rest -= root[i][j] * z[j];
    z[i] = rest / root[i][i];
    square += z[i] * z[i];
  }
  // Gamma(7/2) / (Gamma(2) (4 pi)^(3/2)), over sqrt(det) = exp(volume) / (2 pi)^(3/2).
  static const double at_middle = std::log(std::tgamma(3.5) / std::pow(2.0, 1.5));
  return at_middle - 3.5 * std::log1p(square / (4 * kInflation * kInflation)) -
         3 * std::log(kInflation) - volume - std::log(radius_width * ratio_width);
}

std::vector<BallCell> ball_cells(const MapLikelihood& likelihood,
                                 const BallField& field,
                                 const BallPrior& prior) {
  return CellMaker{likelihood, field, prior}.run();
}

}  // namespace palp::depth
