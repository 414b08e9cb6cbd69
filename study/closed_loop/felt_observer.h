#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/result.h"
#include "study/closed_loop/felt_trial.h"
#include "study/formula_participant.h"

/// Somebody who feels the closed loop: knows what FeltSlopes knows, and judges it with the noise
/// that people have.
namespace palp::study {

/// Of one observer. Noise of the logarithm of stiffness: of each tap (force 7 %, Pang, Tan and
/// Durlach 1991; position 8 %, Cappello 2016) and of each judgement, such that with the own finger
/// and three taps the Weber fraction is `weber`.
struct Judgement {
  double tap_sd{};        ///< [-]
  double judgement_sd{};  ///< [-]
  double lapse{0.02};     ///< [-]
  double depth_sd{0.1};   ///< [-], of the depth aimed at
  /// [-], how much of a difference of ln stiffness the slopes show with the own finger: less than
  /// 1, for a hand comes less deep into stiffer tissue, which is less steep there. People know.
  double own_gain{1};

  /// [-], of the difference of two intervals with so many taps each.
  [[nodiscard]] double difference_sd(int taps) const noexcept;
  /// [-], JND where what is felt shows `gain` > 0 of the difference there is; own finger: 1.
  /// `scatter` [-]: standard deviation of that from session to session.
  [[nodiscard]] double jnd(int taps, double gain, double scatter = 0) const noexcept;
};

/// 0.05 <= weber.
[[nodiscard]] Judgement judgement_of(double weber, double lapse, double own_gain) noexcept;

/// "The second is stiffer", from what was felt in each interval: a guess where one of them told
/// nothing. `stream` and `trial` draw the noise.
[[nodiscard]] bool judge_second(const std::array<std::vector<double>, 2>& ln_slopes,
                                const Judgement& judgement,
                                std::uint64_t seed,
                                std::uint64_t stream) noexcept;

/// How much of a difference of ln stiffness slopes show with the own finger [-]; of the condition's
/// grip and taps.
[[nodiscard]] double own_gain(const FeltSession& session);

/// The tissues and taps of a trial. `two_sided`: the first interval is the reference, and `level`
/// has a sign.
[[nodiscard]] FeltSetting setting_of(
    const TrialAsk& ask, bool two_sided, int taps, double depth_sd, std::uint64_t seed);

/// Observers that feel each trial of a study as a session of its own. Thread: any, at once too.
class FeltParticipants {
 public:
  [[nodiscard]] static Result<FeltParticipants> make(const Study& study,
                                                     const PeopleTraits& people);

  /// As an Observer, which this outlives.
  [[nodiscard]] TrialOutcome answer(const TrialPlace& place, const TrialAsk& ask) const;

 private:
  FeltParticipants(const Study& study,
                   const PeopleTraits& people,
                   std::vector<FeltSession> sessions);

  std::uint64_t seed_;
  bool two_sided_;
  PeopleTraits people_;
  std::vector<FeltSession> sessions_;  ///< of each condition
  double own_gain_;                    ///< [-], of the first
};

}  // namespace palp::study
