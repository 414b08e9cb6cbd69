#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/core/place.h"
#include "common/coupling/breath_fit.h"
#include "common/message/port_sample.h"

namespace palp::coupling {

/// A displacement that goes on as a sine: now, a quarter later, and how fast.
struct Swing {
  double now{};         ///< [m]
  double quadrature{};  ///< [m]
  double rate{};        ///< [rad/s]
  /// After `span` [s].
  [[nodiscard]] double after(double span) const noexcept;
};

/// The breathing of a surface, found together with the tissue under it: where one is guessed first
/// and the other afterwards, a wrong breath and a wrong tissue confirm each other. Keeps what the
/// tip met in the last half minute of contact and fits to it a tissue and the way of its surface,
/// for each of several paces, a few samples a tick. Says nothing until such a way explains most of
/// what a surface at rest leaves. What was found at a place is expected there again.
/// Thread: rt; constant memory, bounded work. A value.
class BreathingEstimator {
 public:
  using Shares = std::array<double, kModelTimes.size()>;

  explicit BreathingEstimator(double period) noexcept;       ///< [s], between calls of step()
  void step() noexcept;                                      ///< time goes on
  void pass_unseen(double span) noexcept { time_ += span; }  ///< [s], in which nobody looked
  /// The tip at `position` [m] meets `force` [N], both through the same filters. Every tick.
  void see(double position, double force) noexcept;
  /// A tissue at rest leaves `square` [N^2] of what was felt, in the mean; whether that `explains`
  /// it. Then, or where a breath leaves not clearly less, none is believed anew.
  void rest(double square, bool explains) noexcept {
    rest_square_ = square;
    rests_ = explains;
  }
  /// Another place, and with it another surface and tissue; it breathes with the same breath.
  void new_place(const Place& place) noexcept;

  [[nodiscard]] Swing swing() const noexcept;
  /// A swing is believed, and with it:
  [[nodiscard]] bool believed() const noexcept { return believed_; }
  [[nodiscard]] double surface() const noexcept;                            ///< [m], mean
  [[nodiscard]] std::array<double, kBreathShapes> shapes() const noexcept;  ///< [N]
  [[nodiscard]] Shares relaxing() const noexcept;                           ///< [-]
  /// Seen for long enough to say whether it breathes.
  [[nodiscard]] bool settled() const noexcept;
  /// Seen for long enough to say that it does not breathe.
  [[nodiscard]] bool still() const noexcept { return still_; }

 private:
  static constexpr std::size_t kSamples = 384;
  static constexpr std::size_t kPaces = 6;
  static constexpr std::size_t kPlaces = 16;

  struct Kept {
    BreathSample sample;
    std::uint32_t visit{};  ///< of a place
  };
  /// The newest of all that were felt.
  struct Samples {
    std::array<Kept, kSamples> kept{};
    std::uint64_t count{};  ///< that were ever kept

    [[nodiscard]] const Kept& number(std::uint64_t n) const noexcept { return kept[n % kSamples]; }
    [[nodiscard]] std::uint64_t oldest() const noexcept {
      return count - std::min<std::uint64_t>(count, kSamples);
    }
    void add(const Kept& one) noexcept { kept[count++ % kSamples] = one; }
  };
  /// What was found at places, one after the other.
  struct Places {
    struct Known {
      Place place;
      std::uint32_t visit{};  ///< the last; 0: none
      BreathPrior found;
    };
    std::array<Known, kPlaces> known{};

    [[nodiscard]] const BreathPrior* at(const Place& place) const noexcept;
    void remember(const Known& one) noexcept;
  };
  /// This place.
  struct Here {
    Place place;
    std::uint32_t visit{1};
    std::size_t samples{};
    bool touched{};
    bool known{};  ///< from a visit before
    bool told{};   ///< what is told is of here
    BreathPrior expected = first_breath_prior();
  };
  /// Where the fits are: one after the other through all samples.
  struct Turn {
    std::uint32_t rounds{};  ///< still to go
    std::size_t fit{};
    std::uint64_t sample{};  ///< number
  };

  void touch(double position, double force) noexcept;
  void fit_some() noexcept;
  void judge() noexcept;
  void tell() noexcept;
  void follow(const BreathSample& sample) noexcept;

  double period_;  ///< [s]
  double time_{};  ///< [s]
  Samples samples_;
  Places places_;
  Here here_;
  Shares past_{};                           ///< [N], the force on exponential averages
  double contact_at_{-1};                   ///< [s], last
  double first_seen_{-1};                   ///< [s]
  std::array<BreathFit, kPaces + 1> fits_;  ///< the first of a surface at rest
  Turn turn_;
  std::size_t best_{1};
  BreathFit told_;     ///< as judged last; its path goes on with every sample
  double presence_{};  ///< [-], fades in and out
  bool believed_{};
  bool still_{};
  bool rests_{};                                                 ///< what was felt needs no breath
  double rest_square_{std::numeric_limits<double>::infinity()};  ///< [N^2], left without one
};

}  // namespace palp::coupling
