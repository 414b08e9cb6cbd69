#include "fem/bonded_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "fem/dense_solver.h"

namespace palp::fem {
namespace {

constexpr int kPoints = 24;         // of the equation over the contact
constexpr int kKernelPoints = 100;  // of the kernel's integral
constexpr double kKernelEnd = 40;   // [-], of wave number times height: the rest is below 1e-30

/// Gauss-Legendre over [0, length]: places and weights.
std::vector<std::pair<double, double>> gauss(int count, double length) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(count, count);
  for (int i = 1; i < count; ++i) {
    jacobi(i, i - 1) = jacobi(i - 1, i) = i / std::sqrt(4.0 * i * i - 1);
  }
  const Spectrum spectrum = spectrum_of(jacobi);
  std::vector<std::pair<double, double>> out;
  for (int i = 0; i < count; ++i) {
    const double first = spectrum.vectors(0, i);
    out.emplace_back(0.5 * length * (1 + spectrum.values[i]), length * first * first);
  }
  return out;
}

/// 1 - Z: what the base takes from the surface's compliance at wave number s / height. Written with
/// e^(-2 s), or the hyperbolic functions overflow.
double stiffened(double s, double poisson) {
  const double k = 3 - 4 * poisson;
  const double decay = std::exp(-2 * s);
  const double sine = 0.5 * (1 - decay);    // sinh(s) e^(-s)
  const double cosine = 0.5 * (1 + decay);  // cosh(s) e^(-s)
  const double top = k * sine * cosine - s * decay;
  const double bottom = k * sine * sine + (s * s + 4 * (1 - poisson) * (1 - poisson)) * decay;
  return 1 - top / bottom;
}

}  // namespace

BondedLayer::Answer BondedLayer::pressed_to(double contact) const {
  const double pi = std::numbers::pi;
  const auto places = gauss(kPoints, contact);
  const auto waves = gauss(kKernelPoints, kKernelEnd);
  std::vector<double> weight;
  for (const auto& [s, share] : waves) weight.push_back(share * stiffened(s, poisson) / height);
  const auto kernel = [&](double x) {
    double sum = 0;
    for (std::size_t i = 0; i < waves.size(); ++i) {
      sum += weight[i] * std::cos(waves[i].first * x / height);
    }
    return sum / pi;
  };
  // Last row: the contact's edge, where the pressure must vanish.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(kPoints + 1, kPoints + 1);
  Eigen::MatrixXd right(kPoints + 1, 2);  // of a unit indentation, of the sphere's shape
  const double modulus = youngs_modulus / (1 - poisson * poisson) / pi;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = i < kPoints ? places[static_cast<std::size_t>(i)].first : contact;
    for (int j = 0; j < kPoints; ++j) {
      const auto& [s, share] = places[static_cast<std::size_t>(j)];
      matrix(i, j) -= share * (kernel(t - s) + kernel(t + s));
    }
    right(i, 0) = modulus;
    right(i, 1) = modulus * 0.5 * t * std::log((radius + t) / (radius - t));
  }
  const Eigen::MatrixXd density = solve(matrix, right);
  Answer answer;
  answer.indentation = density(kPoints, 1) / density(kPoints, 0);
  for (int i = 0; i < kPoints; ++i) {
    answer.force += 2 * pi * places[static_cast<std::size_t>(i)].second *
                    (answer.indentation * density(i, 0) - density(i, 1));
  }
  return answer;
}

double BondedLayer::force(double indentation) const {
  // Secants from Hertz's radius; the contact grows smoothly with the indentation.
  double near = std::sqrt(0.5 * radius * indentation);
  double far = std::min(1.4 * near, 0.99 * radius);
  double off_near = pressed_to(near).indentation - indentation;
  for (int pass = 0; pass < 30; ++pass) {
    const double off_far = pressed_to(far).indentation - indentation;
    if (std::abs(off_far) < 1e-10 * indentation || off_far == off_near) break;
    const double next = far - off_far * (far - near) / (off_far - off_near);
    near = far;
    off_near = off_far;
    far = std::clamp(next, 0.5 * far, 0.5 * (far + radius));
  }
  return pressed_to(far).force;
}

}  // namespace palp::fem
