#pragma once

#include <cstdint>

namespace palp::patient {

struct BreathConfig {
  double amplitude{};     ///< [m], of the surface; 0: it stands still
  double frequency{};     ///< [Hz]
  double variation{};     ///< [-], 0 to 0.5: by up to this share each half of a breath is longer
                          ///< or shorter, deeper or shallower than the mean one
  std::uint64_t seed{1};  ///< of what is drawn
};

/// How far breathing moves a surface. Without variation a sine. With it the surface goes from one
/// turn to the next along half a cosine, so that it moves smoothly and rests at each turn. Pure but
/// for what it remembers of the present half. Thread: rt. A value.
class Breath {
 public:
  explicit Breath(const BreathConfig& config) noexcept;

  struct Motion {
    double position{};  ///< [m], + into the tissue
    double velocity{};  ///< [m/s]
  };
  /// `time` [s] >= 0, never before that of the last call.
  Motion at(double time) noexcept;

 private:
  void breathe_on() noexcept;
  [[nodiscard]] double varied(std::uint64_t draw) const noexcept;

  BreathConfig config_;
  std::uint64_t half_{};  ///< number of the present one
  double from_{};         ///< [m], where it began
  double to_{};           ///< [m], where it ends
  double began_{};        ///< [s]
  double span_{};         ///< [s]
};

}  // namespace palp::patient
