#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace palp::depth {

/// Mean of the samples of one bin.
struct ContactPoint {
  double position{};  ///< [m], tip
  double force{};     ///< [N]
  double rate{};      ///< [m/s], of the tip
  double count{};     ///< [-], samples behind it
};

/// Force over position of one place, binned: a hold counts as one point and strokes of one place
/// add up. Loading and unloading have bins of their own.
/// A value. Thread: estimator.
class ContactCurve {
 public:
  static constexpr double kBinWidth = 50e-6;  ///< [m], a hundredth of the stroke
  static constexpr std::size_t kBins = 240;   ///< 12 mm

  /// Covers 5 mm of air and 7 mm of tissue around `first_contact` [m].
  explicit ContactCurve(double first_contact);

  enum class Branch : std::size_t { Loading, Unloading };
  void add(Branch branch,
           double position,
           double force,
           double rate) noexcept;                ///< [m], [N], [m/s]
  void add(const ContactCurve& other) noexcept;  ///< of the same place: the bins must agree
  void scale(double factor) noexcept;            ///< of every count: forget in part

  /// The occupied bins.
  [[nodiscard]] std::vector<ContactPoint> points() const;
  [[nodiscard]] double begin() const noexcept { return begin_; }  ///< [m]

 private:
  double begin_;                                ///< [m], of the first bin
  std::array<ContactPoint, 2 * kBins> sums_{};  ///< values times count
};

}  // namespace palp::depth
