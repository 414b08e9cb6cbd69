#include "depth/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/conventions.h"
#include "depth/least_squares.h"

namespace palp::depth {
namespace {

constexpr std::size_t kTerms = 5;
using Squares = LeastSquares<kTerms>;

/// What may be assumed of the coefficients before any data: mean and standard deviation of each,
/// relative to the first. `charge` is what an assumption costs, so that a looser one is taken only
/// for a clear gain of chi^2. Means and widths span what finite element solutions give for balls,
/// columns and cylinders 5 to 25 mm deep, in small and in finite strain.
struct Assumption {
  bool paper_tissue{};  ///< the first coefficient is near Hertz' for the paper's block
  double charge{};
  std::array<double, kTerms> mean{};
  std::array<double, kTerms> width{};
};

constexpr std::array<Assumption, 4> kAssumptions{{
    {true, 0, {1, 0.1, -0.02, -0.01, 0}, {0.02, 0.3, 0.03, 0.015, 0.01}},
    {false, 12, {1, 0.15, -0.02, -0.01, 0}, {1, 0.3, 0.02, 0.005, 0.0025}},
    {true, 24, {1, 0.1, -0.02, -0.01, 0}, {0.05, 0.6, 0.3, 0.2, 0.05}},
    {false, 36, {1, 0.1, -0.02, -0.01, 0}, {1, 0.6, 0.8, 0.56, 0.16}},
}};

// Even without noise a five-term law misses a tissue by so much: absolute, and of the force.
constexpr double kLawError = 50e-6;        // [N]
constexpr double kLawErrorShare = 0.5e-3;  // [-]

std::array<double, kTerms> regressors(double indentation) noexcept {
  const double xi = std::max(0.0, indentation / kMillimetre);
  const double root = std::sqrt(xi);
  const double square = xi * xi;
  return {xi * root, square, square * root, square * xi, square * xi * root};
}

/// The data seen from one candidate surface.
struct Candidate {
  Squares squares;
  double hertz{};  ///< [N], first coefficient of the best law with no other
};

struct Fit {
  double surface{};
  Squares::Solution solution;
  double cost{std::numeric_limits<double>::infinity()};
};

class Search {
 public:
  Search(const SurfaceInput& input, const SurfaceConfig& config)
      : input_{input},
        config_{config},
        cut_{input.surface.value_or(input.first_contact) + config.indentation_max} {}

  /// Best fit under each assumption with the surface between `from` and `to` [m].
  [[nodiscard]] Fit best(double from, double to) const {
    std::array<Fit, kAssumptions.size()> fits;
    const int steps = std::max(2, static_cast<int>(std::ceil((to - from) / config_.step)));
    const double step = (to - from) / steps;
    for (int i = 0; i <= steps; ++i) {
      const double surface = from + step * i;
      const Candidate candidate = look_from(surface);
      for (std::size_t k = 0; k < fits.size(); ++k) take(fits[k], candidate, surface, k);
    }
    Fit winner;
    for (std::size_t k = 0; k < fits.size(); ++k) {
      refine(fits[k], k, step);
      fits[k].cost += kAssumptions[k].charge;
      if (fits[k].cost < winner.cost) winner = fits[k];
    }
    return winner;
  }

 private:
  [[nodiscard]] Candidate look_from(double surface) const {
    Candidate candidate;
    double hertz_force = 0;
    double hertz_square = 0;
    const double noise_square = input_.noise * input_.noise;
    for (const ContactPoint& point : input_.points) {
      if (point.position > cut_) continue;
      const double force = point.force / (1 + input_.rate_factor * point.rate);
      const double share = kLawErrorShare * force;
      const double weight =
          1 / (noise_square / point.count + kLawError * kLawError + share * share);
      const auto phi = regressors(point.position - surface);
      candidate.squares.add(phi, force, weight);
      hertz_force += weight * phi[0] * force;
      hertz_square += weight * phi[0] * phi[0];
    }
    candidate.hertz = hertz_square > 0 ? hertz_force / hertz_square : 0;
    return candidate;
  }

  void take(Fit& fit, const Candidate& candidate, double surface, std::size_t index) const {
    if (!(candidate.hertz > 0)) return;
    const Assumption& assumption = kAssumptions[index];
    const double scale = assumption.paper_tissue ? config_.hertz_force : candidate.hertz;
    Squares squares = candidate.squares;
    for (std::size_t j = 0; j < kTerms; ++j) {
      const double width = assumption.width[j] * scale;
      squares.add_prior(j, assumption.mean[j] * scale, 1 / (width * width));
    }
    const Squares::Solution solution = squares.solve();
    if (!solution.regular || !(solution.cost < fit.cost)) return;
    fit = {.surface = surface, .solution = solution, .cost = solution.cost};
  }

  /// Golden-section search in the two steps around the best grid point.
  void refine(Fit& fit, std::size_t index, double step) const {
    if (!std::isfinite(fit.cost)) return;
    constexpr double kGolden = 0.61803398874989485;
    double low = fit.surface - step;
    double high = fit.surface + step;
    const auto cost_at = [&](double surface) {
      Fit trial;
      take(trial, look_from(surface), surface, index);
      if (trial.cost < fit.cost) fit = trial;
      return trial.cost;
    };
    double left = high - kGolden * (high - low);
    double right = low + kGolden * (high - low);
    double cost_left = cost_at(left);
    double cost_right = cost_at(right);
    for (int i = 0; i < 9; ++i) {
      if (cost_left < cost_right) {
        high = right;
        right = left;
        cost_right = cost_left;
        left = high - kGolden * (high - low);
        cost_left = cost_at(left);
      } else {
        low = left;
        left = right;
        cost_left = cost_right;
        right = low + kGolden * (high - low);
        cost_right = cost_at(right);
      }
    }
  }

  SurfaceInput input_;
  SurfaceConfig config_;
  double cut_;  ///< [m], deepest position used
};

}  // namespace

double ContactLaw::force(double indentation) const noexcept {
  if (!(indentation > 0)) return 0;
  const auto phi = regressors(indentation);
  double sum = 0;
  for (std::size_t j = 0; j < kTerms; ++j) sum += c[j] * phi[j];
  return sum;
}

std::optional<ContactLaw> find_surface(const SurfaceInput& input, const SurfaceConfig& config) {
  const Search search{input, config};
  const double outermost = input.first_contact - config.search_out;
  const double innermost = input.first_contact + config.search_in;
  Fit fit;
  if (input.surface) {
    const double near = 6 * config.step;
    fit = search.best(*input.surface - near, *input.surface + near);
    if (std::abs(fit.surface - *input.surface) > 5 * config.step) fit = Fit{};
  }
  if (!std::isfinite(fit.cost)) fit = search.best(outermost, innermost);
  if (!std::isfinite(fit.cost)) return std::nullopt;
  if (fit.surface < outermost || fit.surface > innermost) return std::nullopt;
  return ContactLaw{.surface = fit.surface, .c = fit.solution.x, .rate_factor = input.rate_factor};
}

}  // namespace palp::depth
