#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/core/place.h"
#include "common/core/result.h"
#include "study/level_curves.h"
#include "study/study_file.h"
#include "study/trial_row.h"

/// A trial as a whole session in virtual time: the sites' own programs, a link, a tissue with a
/// place for each interval, a hand with a will.
namespace palp::study {

/// An interval's tissue, and how the hand goes about it.
struct FeltPlace {
  double ln_stiffness{};        ///< [-], over the plain tissue's: the level
  std::vector<double> depth{};  ///< [m], aimed at in plain tissue, of each tap
  double delay{};               ///< [ms], of the way down, on top of the link's
  std::optional<Place> at{};    ///< nothing: A, B, and on as far apart
};

/// A ball somewhere below the places of a search, in place of what they say of tissue.
struct HiddenBall {
  double level{};  ///< [-], of the study: its contrast
  Place axis{};
};

/// A trial.
struct FeltSetting {
  std::vector<FeltPlace> places{};  ///< of each interval, 1 or more; without `hidden` 8 at most
  std::uint64_t seed{};             ///< of the session's noise
  std::optional<HiddenBall> hidden{};
  bool plain{};  ///< levels make plain tissue stiffer, whatever else the study's are
};

/// What is known of an interval, by the hand, by the eyes, by the estimator of the depth.
struct FeltInterval {
  std::vector<double> ln_slopes{};     ///< [ln N/m], felt, by which it is judged
  std::vector<double> ln_drawn{};      ///< [ln N/m], force drawn over depth, likewise
  std::optional<double> ball_depth{};  ///< [m], of a ball that the estimator found; nothing: none
  std::optional<double> lag{};         ///< [ms], of the force behind the hand; nothing: no force
};

/// What came of it.
struct FeltTrial {
  std::vector<FeltInterval> intervals{};
  double duration{};  ///< [s], to the question
  int taps{};
  double force_max{};   ///< [N]
  double contact{};     ///< [s]
  double force_mean{};  ///< [N], of the tip while it touched
};

/// Sessions of one condition, which is read once. Thread: any, feel() at once too.
class FeltSession {
 public:
  [[nodiscard]] static Result<FeltSession> make(const Condition& condition,
                                                const LevelCurves& curves = {});
  FeltSession(FeltSession&& other) noexcept;
  FeltSession& operator=(FeltSession&& other) noexcept;
  ~FeltSession();

  /// All intervals over the link, through the stages of a Trial.
  [[nodiscard]] FeltTrial feel(const FeltSetting& setting) const;
  /// The same hand at the same tissue with its own finger: no device, no link, no stage.
  [[nodiscard]] FeltTrial touch(const FeltSetting& setting) const;
  /// [s], that a place of a search takes with so many taps.
  [[nodiscard]] static double place_time(int taps) noexcept;
  [[nodiscard]] Feedback feedback() const noexcept { return feedback_; }
  [[nodiscard]] int taps() const noexcept { return taps_; }
  /// Taps of an interval by which an observer judges: all but the first ones of the condition.
  [[nodiscard]] int judged() const noexcept { return taps_ - unjudged_; }

 private:
  struct Parts;
  FeltSession(std::unique_ptr<Parts> parts, const Condition& condition) noexcept;
  [[nodiscard]] FeltTrial judged_of(FeltTrial felt) const;

  std::unique_ptr<Parts> parts_;
  Feedback feedback_;
  int taps_;
  int unjudged_;
};

}  // namespace palp::study
