#pragma once

#include <array>
#include <cstddef>

namespace palp::patient {

/// A tissue held at one depth lets go of shares of its force: F(t) is the elastic force less, for
/// each of some times, a share of what that was on exponential average (Fung 1993, quasi-linear
/// viscoelasticity as a Prony series).
struct Relaxation {
  struct Part {
    double share{};  ///< [-]; 0: none
    double time{1};  ///< [s]
  };
  static constexpr std::size_t kParts = 10;
  std::array<Part, kParts> parts{};  ///< those without a share come last
};

/// What lets go of `share` [-] in all as 1 - exp(-sqrt(t/time)): no one time says it. As the fluid
/// drains out of a tissue after a step (Hu, Zhao, Vlassak and Suo 2010: a spherical tip, short
/// times), to 0.4 % of the force let go of from 10 ms to 60 s.
[[nodiscard]] Relaxation stretched_relaxation(double share, double time) noexcept;

/// The history of one place where such a tissue is pressed. A value.
class RelaxingForce {
 public:
  explicit RelaxingForce(const Relaxation& relaxation) noexcept : relaxation_{relaxation} {}
  /// The force [N] where the elastic one is `elastic` [N]; `span` [s] since the last call.
  double step(double elastic, double span) noexcept {
    double force = elastic;
    for (std::size_t k = 0; k < past_.size() && relaxation_.parts[k].share > 0; ++k) {
      past_[k] += span / relaxation_.parts[k].time * (elastic - past_[k]);
      force -= relaxation_.parts[k].share * past_[k];
    }
    return elastic > 0 && force > 0 ? force : 0;
  }

 private:
  Relaxation relaxation_;
  std::array<double, Relaxation::kParts> past_{};  ///< [N]
};

}  // namespace palp::patient
