#include "depth/contact_curve.h"

#include "common/core/check.h"

namespace palp::depth {
namespace {

constexpr double kAir = 5e-3;  // [m], of the curve before the first contact

}  // namespace

ContactCurve::ContactCurve(double first_contact) : begin_{first_contact - kAir} {}

void ContactCurve::add(Branch branch, double position, double force, double rate) noexcept {
  const double bin = (position - begin_) / kBinWidth;
  if (!(bin >= 0 && bin < static_cast<double>(kBins))) return;
  const std::size_t offset = branch == Branch::Loading ? 0 : kBins;
  ContactPoint& sum = sums_[offset + static_cast<std::size_t>(bin)];
  sum.position += position;
  sum.force += force;
  sum.rate += rate;
  sum.count += 1;
}

void ContactCurve::add(const ContactCurve& other) noexcept {
  PALP_CHECK(begin_ == other.begin_, "curves of one place share their bins");
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i].position += other.sums_[i].position;
    sums_[i].force += other.sums_[i].force;
    sums_[i].rate += other.sums_[i].rate;
    sums_[i].count += other.sums_[i].count;
  }
}

void ContactCurve::scale(double factor) noexcept {
  for (ContactPoint& sum : sums_) {
    sum.position *= factor;
    sum.force *= factor;
    sum.rate *= factor;
    sum.count *= factor;
  }
}

std::vector<ContactPoint> ContactCurve::points() const {
  std::vector<ContactPoint> points;
  points.reserve(sums_.size());
  for (const ContactPoint& sum : sums_) {
    if (!(sum.count > 0)) continue;
    points.push_back(
        {sum.position / sum.count, sum.force / sum.count, sum.rate / sum.count, sum.count});
  }
  return points;
}

}  // namespace palp::depth
