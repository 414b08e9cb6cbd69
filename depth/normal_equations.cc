#include "depth/normal_equations.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palp::depth {
namespace {

constexpr double kStep = 25e-6;     // [m], of the basis' table
constexpr int kBlock = 4;           // samples added up before they are squared
constexpr double kSettled = 25e-3;  // [s], three times the memory of the transducer's pole

using Columns = NormalEquations::Columns;

/// The terms' forces at one instant, and what an unknown surface and rate make of them.
Columns columns_at(const CurveBasis& basis, double indentation, double rate) noexcept {
  const CurveBasis::Row row = basis.at(indentation);
  Columns out;
  for (std::size_t m = 0; m < kCurveTerms; ++m) {
    out[m] = row.force[m];
    out[kCurveTerms + m] = -row.slope[m];
    out[2 * kCurveTerms + m] = rate * row.force[m];
  }
  return out;
}

/// The weights that turn columns into the force of a model seen from `surface`.
Columns weights_of(const TouchModel& model, double surface) noexcept {
  Columns out;
  const double shift = model.surface - surface;
  for (std::size_t m = 0; m < kCurveTerms; ++m) {
    out[m] = model.scale * model.curve[m];
    out[kCurveTerms + m] = shift * out[m];
    out[2 * kCurveTerms + m] = model.rate_factor * out[m];
  }
  return out;
}

/// The transducer's pole of all columns. Between two samples it sees both.
class ColumnPole {
 public:
  explicit ColumnPole(double cut_off) : cut_off_{cut_off} {}
  const Columns& step(const Columns& input, double span) noexcept {
    if (span != span_) {
      span_ = span;
      gain_ = cut_off_ > 0 ? 1 - std::exp(-2 * std::numbers::pi * cut_off_ * span) : 1;
      before_share_ = cut_off_ > 0 ? 0.5 : 0;
    }
    for (std::size_t k = 0; k < value_.size(); ++k) {
      const double seen = input[k] + before_share_ * (before_[k] - input[k]);
      value_[k] += gain_ * (seen - value_[k]);
    }
    before_ = input;
    return value_;
  }

 private:
  double cut_off_;  ///< [Hz]
  double span_{-1};
  double gain_{};
  double before_share_{};
  Columns before_{};
  Columns value_{};
};

double dot(const Columns& a, const Columns& b) noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

}  // namespace

CurveBasis::CurveBasis(const DepthDatabase& database) {
  const auto plain = database.plain();
  const auto count = static_cast<std::size_t>(kCurveReach / kStep) + 2;
  const auto at = [&](double indentation) {
    CurveTerms out = curve_polynomials(indentation);
    const double force = database.force(plain, indentation);
    for (double& term : out) term *= force;
    return out;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double indentation = static_cast<double>(i) * kStep;
    Row row{.force = at(indentation), .slope = {}};
    const double low = std::max(0.0, indentation - 0.1 * kStep);
    const double high = std::min(kCurveReach, indentation + 0.1 * kStep);
    const CurveTerms before = at(low);
    const CurveTerms behind = at(high);
    for (std::size_t m = 0; m < kCurveTerms; ++m) {
      row.slope[m] = (behind[m] - before[m]) / (high - low);
    }
    rows_.push_back(row);
  }
}

CurveBasis::Row CurveBasis::at(double indentation) const noexcept {
  if (!(indentation > 0)) return {};
  const double place = std::min(indentation / kStep, static_cast<double>(rows_.size()) - 1.001);
  const auto entry = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(entry);
  Row out;
  for (std::size_t m = 0; m < kCurveTerms; ++m) {
    const Row& low = rows_[entry];
    const Row& high = rows_[entry + 1];
    out.force[m] = low.force[m] + share * (high.force[m] - low.force[m]);
    out.slope[m] = low.slope[m] + share * (high.slope[m] - low.slope[m]);
  }
  return out;
}

/// The reading's mean is not quite the force, and its noise depends on where between two steps the
/// force lies: each sample counts with what it tells about the force expected there.
void NormalEquations::add(std::span<const TouchSample> touch, const Reading& reading) {
  ColumnPole pole{reading.cut_off};
  Columns model{};
  if (reading.expected) model = weights_of(*reading.expected, surface_);
  Columns block{};
  double block_weight = 0;
  int count = 0;
  const auto finish = [&] {
    if (block_weight > 0) add(block, block_weight);
    block = {};
    block_weight = 0;
    count = 0;
  };
  double since_deep = kSettled;  // [s]
  for (std::size_t i = 1; i < touch.size(); ++i) {
    const TouchSample& sample = touch[i];
    const double indentation = sample.tip - surface_;
    const double rate = (sample.tip - touch[i - 1].tip) / sample.span;
    const Columns& x = pole.step(columns_at(reading.basis, indentation, rate), sample.span);
    since_deep = indentation > kDeepestPoint ? 0 : since_deep + sample.span;
    if (!sample.read) {
      finish();  // the next one lies far from those before
      continue;
    }
    if (since_deep < kSettled || !(x[0] > 0)) continue;
    double weight = 1 / (reading.noise * reading.noise);
    double told = weight * sample.force;  // weight times what the sample says of the force
    double square = told * sample.force;
    if (reading.expected) {
      const double force = dot(model, x);
      const SensorSteps::Reading steps = reading.steps.at(force);
      const double rest = sample.force - force - steps.offset;
      weight = steps.slope * steps.slope / steps.variance;
      told = weight * force + steps.slope * rest / steps.variance;
      square = weight * force * force + 2 * steps.slope * rest * force / steps.variance +
               rest * rest / steps.variance;
    }
    for (std::size_t k = 0; k < kColumns; ++k) {
      block[k] += weight * x[k];
      right_[k] += told * x[k];
    }
    block_weight += weight;
    weights_ += weight;
    squares_ += square;
    samples_ += 1;
    if (++count == kBlock) finish();
  }
  finish();
}

/// `columns` is a sum, of which `weight` is the sum of the weights.
void NormalEquations::add(const Columns& columns, double weight) noexcept {
  const double share = 1 / weight;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const double left = share * columns[i];
    for (std::size_t j = i / kCurveTerms * kCurveTerms; j < kColumns; ++j) {
      matrix_[i][j] += left * columns[j];
    }
  }
}

void NormalEquations::add(const NormalEquations& other) noexcept {
  for (std::size_t i = 0; i < kColumns; ++i) {
    for (std::size_t j = 0; j < kColumns; ++j) matrix_[i][j] += other.matrix_[i][j];
    right_[i] += other.right_[i];
  }
  weights_ += other.weights_;
  squares_ += other.squares_;
  samples_ += other.samples_;
}

void NormalEquations::scale(double factor) noexcept {
  for (std::size_t i = 0; i < kColumns; ++i) {
    for (double& value : matrix_[i]) value *= factor;
    right_[i] *= factor;
  }
  weights_ *= factor;
  squares_ *= factor;
  samples_ *= factor;
}

/// To first order the force seen from elsewhere is the force plus the step times its slope, which
/// is the second block of columns: the first block takes up so much of it.
void NormalEquations::move_to(double surface) noexcept {
  const double step = surface - surface_;
  surface_ = surface;
  constexpr std::size_t kNext = kCurveTerms;
  for (std::size_t i = 0; i < kCurveTerms; ++i) {
    for (std::size_t j = 0; j < kCurveTerms; ++j) {
      matrix_[i][j] += step * (matrix_[i][kNext + j] + matrix_[j][kNext + i] +
                               step * matrix_[kNext + i][kNext + j]);
    }
  }
  for (std::size_t i = 0; i < kCurveTerms; ++i) {
    for (std::size_t j = 0; j < kCurveTerms; ++j) {
      matrix_[i][kNext + j] += step * matrix_[kNext + i][kNext + j];
      matrix_[i][2 * kNext + j] += step * matrix_[kNext + i][2 * kNext + j];
    }
    right_[i] += step * right_[kNext + i];
  }
}

double NormalEquations::along(std::size_t i, const CurveTerms& curve) const noexcept {
  double sum = 0;
  for (std::size_t m = 0; m < kCurveTerms; ++m) sum += right_[i * kCurveTerms + m] * curve[m];
  return sum;
}

/// Row by row: sums that run side by side are several times faster than one after the other.
NormalEquations::Columns NormalEquations::rows(std::size_t i,
                                               const CurveTerms& curve) const noexcept {
  Columns out{};
  for (std::size_t m = 0; m < kCurveTerms; ++m) {
    const Columns& row = matrix_[i * kCurveTerms + m];
    for (std::size_t k = 0; k < kColumns; ++k) out[k] += curve[m] * row[k];
  }
  return out;
}

double NormalEquations::between(const Columns& rows,
                                std::size_t j,
                                const CurveTerms& curve) noexcept {
  double sum = 0;
  for (std::size_t n = 0; n < kCurveTerms; ++n) sum += rows[j * kCurveTerms + n] * curve[n];
  return sum;
}

}  // namespace palp::depth
