#include "fem/cubic_spline.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

const std::vector<double> kPlaces{0, 0.3, 0.5, 0.9, 1.2, 1.6, 2, 2.3, 2.7, 3};

Eigen::VectorXd at_places(double (*function)(double)) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(kPlaces.size()));
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    out[static_cast<Eigen::Index>(i)] = function(kPlaces[i]);
  }
  return out;
}

TEST(CubicSplineTest, GoesThroughThePlacesAndKeepsConstants) {
  for (const Parity parity : {Parity::Even, Parity::Odd}) {
    const CubicSpline spline{kPlaces, parity};
    const Eigen::MatrixXd own = spline.weights(kPlaces);
    EXPECT_LT((own - Eigen::MatrixXd::Identity(own.rows(), own.cols())).norm(), 1e-12);
    const Eigen::VectorXd sums = spline.weights({0.1, 0.77, 2.95}).rowwise().sum();
    EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-12);
  }
}

// Beyond the axis an even function comes down as it went up, an odd one turns its sign.
TEST(CubicSplineTest, KnowsTheFunctionBeyondZeroByItsParity) {
  const CubicSpline even{kPlaces, Parity::Even};
  const CubicSpline odd{kPlaces, Parity::Odd};
  const Eigen::VectorXd cosine = at_places([](double x) { return std::cos(x); });
  const Eigen::VectorXd sine = at_places([](double x) { return std::sin(x); });
  for (const double x : {0.02, 0.15, 0.4, 1.05, 1.9}) {
    EXPECT_NEAR((even.weights({x}) * cosine)[0], std::cos(x), 3e-4) << x;
    EXPECT_NEAR((odd.weights({x}) * sine)[0], std::sin(x), 3e-4) << x;
  }
  const double tiny = 1e-4;
  EXPECT_NEAR((even.weights({tiny}) * sine)[0] / tiny, 0, 0.01);  // it has no slope there
  EXPECT_NEAR((odd.weights({tiny}) * sine)[0] / tiny, 1, 0.01);
}

}  // namespace
}  // namespace palp::fem
