#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/core/small_solver.h"
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
/// tip met in the last half minute of contact and fits to it, for each of several paces, surface,
/// swing, pace, stiffness and what relaxes at once, a few samples a tick (Gauss and Newton, damped
/// as by Marquardt). Says nothing until a swing explains most of what a surface at rest leaves.
/// Thread: rt; constant memory, bounded work. A value.
class BreathingEstimator {
 public:
  /// Of model_shapes(): the second to the fourth.
  static constexpr std::size_t kShapes = 3;
  static constexpr std::size_t kPaces = 16;
  static constexpr std::size_t kTimes = kModelTimes.size();
  using Shares = std::array<double, kTimes>;

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
  void new_place() noexcept;

  [[nodiscard]] Swing swing() const noexcept;
  /// A swing is believed, and with it:
  [[nodiscard]] bool believed() const noexcept { return believed_; }
  [[nodiscard]] double surface() const noexcept;                      ///< [m], mean
  [[nodiscard]] std::array<double, kShapes> shapes() const noexcept;  ///< [N]
  [[nodiscard]] const Shares& relaxing() const noexcept;              ///< [-]
  /// Seen for long enough to say whether it breathes.
  [[nodiscard]] bool settled() const noexcept;
  /// Seen for long enough to say that it does not breathe.
  [[nodiscard]] bool still() const noexcept { return still_; }

 private:
  static constexpr std::size_t kSamples = 384;
  /// And surface, what relaxes, cosine, sine, rate.
  static constexpr std::size_t kUnknowns = kShapes + kTimes + 4;

  struct Sample {
    double at{};        ///< [s]
    double position{};  ///< [m]
    double force{};     ///< [N]
    Shares past{};      ///< [N], the force on exponential averages
    std::uint32_t place{};
  };
  struct Tissue {
    double surface{};                     ///< [m]
    std::array<double, kShapes> shape{};  ///< [N], each >= 0, to a quick tip
    Shares relaxing{};                    ///< [-], each >= 0
  };
  /// What is supposed at one pace; the first supposes a surface at rest.
  struct Guess {
    Tissue here;
    Tissue before;    ///< at the last place, as it was found there
    double cosine{};  ///< [m]
    double sine{};    ///< [m]
    double rate{};    ///< [rad/s]
    double origin{};  ///< [s], of the phase
    double square{};  ///< [N^2], of what is left, weighted mean
    double cost{};    ///< [-]
  };
  struct Equations {
    SmallSystem<kUnknowns> system;  ///< [N^2], by unknowns
    double square{};                ///< [N^2], weighted
    double time{};                  ///< [s], sum
    double count{};                 ///< [-]
  };

  void fit_some() noexcept;
  void add(const Guess& guess, const Sample& sample) noexcept;
  [[nodiscard]] std::array<double, kUnknowns> solved(
      const std::array<bool, kUnknowns>& open) const noexcept;
  static void count_from(double origin, Guess& guess) noexcept;
  void improve(Guess& guess, std::size_t pace) noexcept;
  void judge() noexcept;

  double period_;  ///< [s]
  double time_{};  ///< [s]
  std::array<Sample, kSamples> samples_{};
  std::size_t count_{};
  std::size_t next_{};
  std::size_t here_{};  ///< samples at this place
  std::uint32_t place_{};
  bool touched_{};         ///< this place
  Shares past_{};          ///< [N], the force on exponential averages
  double contact_at_{-1};  ///< [s], last
  double first_seen_{-1};  ///< [s]
  std::array<Guess, kPaces + 1> guesses_{};
  std::uint32_t rounds_{};  ///< still to go
  std::size_t at_guess_{};
  std::size_t at_sample_{};
  Equations equations_;
  std::size_t best_{};
  Swing last_;         ///< as judged last
  double judged_{};    ///< [s]
  double presence_{};  ///< [-], fades in and out
  bool believed_{};
  bool still_{};
  bool rests_{};                                                 ///< what was felt needs no breath
  double rest_square_{std::numeric_limits<double>::infinity()};  ///< [N^2], left without one
};

}  // namespace palp::coupling
