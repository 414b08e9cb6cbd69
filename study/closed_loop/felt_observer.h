#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/result.h"
#include "study/closed_loop/felt_trial.h"
#include "study/formula_participant.h"

/// Somebody who feels the closed loop: knows what FeltSlopes knows, and judges it with the noise
/// that people have.
namespace palp::study {

/// Of one observer. Noise of the logarithm of stiffness: of each tap (force 7 %, Pang, Tan and
/// Durlach 1991, or 3 % where it is read; position 8 %, Cappello 2016) and of each judgement, such
/// that with the own finger and three taps the Weber fraction is `weber`.
///
/// Who reads a drawn force judges with the noise of place and judgement that the hand has: only the
/// force is more exact. Of force given and drawn each counts by its reliability; what both have in
/// common they do not make better.
struct Judgement {
  Feedback feedback{Feedback::Force};
  double force_sd{};      ///< [-], of each tap
  double read_sd{};       ///< [-], of each, where the force is read
  double position_sd{};   ///< [-], of each
  double judgement_sd{};  ///< [-]
  bool reads_exactly{};   ///< a force that is read is judged without noise of the judgement
  /// What is judged is how late the force is [ms], with level_unit() times the noise of stiffness.
  bool delays{};
  double lapse{0.02};    ///< [-]
  double depth_sd{0.1};  ///< [-], of the depth aimed at
  /// [-], how much of a difference of ln stiffness the slopes show with the own finger: less than
  /// 1, for a hand comes less deep into stiffer tissue, which is less steep there. People know.
  double own_gain{1};
  double drawn_gain{1};  ///< [-], likewise of the greatest force over the depth, as the hand taps
  /// Yes or no: what plain tissue is known to feel like [ln N/m, as with the own finger]. Who is
  /// asked has felt it often under the condition, and remembers it without error.
  double plain{};
  /// Yes or no: from how much above that on it is "yes" [standard deviations of one judgement].
  double criterion{};

  /// [-, or ms], of one interval with so many taps; what the estimator says has none.
  [[nodiscard]] double sd(int taps) const noexcept;
  /// [-], how much the drawn force counts beside the felt one: 0 or 1 where only one is had.
  [[nodiscard]] double drawn_share(int taps) const noexcept;
  /// [-], JND where what is felt shows `gain` > 0 of the difference there is; own finger: 1.
  /// `scatter` [-]: standard deviation, from session to session, of the difference of two
  /// intervals, or of one where the task is yes or no.
  [[nodiscard]] double jnd(const Task& task, int taps, double gain, double scatter = 0) const;
};

/// 0.05 <= weber.
[[nodiscard]] Judgement judgement_of(double weber, double lapse, double own_gain) noexcept;
/// With the gains of the session's hand, by the session's feedback.
[[nodiscard]] Judgement judgement_for(const FeltSession& session,
                                      const Task& task,
                                      double weber,
                                      double lapse);

/// What an interval leaves, without the observer's noise [ln N/m, as with the own finger; of a
/// delay ms]; nothing where no tap told anything. By the estimator: the less deep a ball, the more
/// [m]; without one kNoBall.
[[nodiscard]] std::optional<double> impression(const FeltInterval& felt,
                                               const Judgement& judgement) noexcept;

inline constexpr double kNoBall = -1;  ///< [m], deeper than any

/// What is chosen, from 0: the stiffest interval, or the latest; of a ranking the order; yes or no:
/// 1, it is stiffer than plain tissue. A guess where an interval left nothing, or two left the
/// same. `seed` and `stream` draw the noise.
[[nodiscard]] std::size_t chosen(const std::vector<FeltInterval>& felt,
                                 const Task& task,
                                 const Judgement& judgement,
                                 std::uint64_t seed,
                                 std::uint64_t stream) noexcept;

/// The tissues and taps of a trial. Bias: the first interval is the reference, and `level` has a
/// sign. Yes or no: one place.
[[nodiscard]] FeltSetting setting_of(
    const TrialAsk& ask, const Task& task, int taps, double depth_sd, std::uint64_t seed);

/// A trial over the link; of a bias the first interval with the own finger.
[[nodiscard]] FeltTrial feel_trial(const FeltSession& session,
                                   const FeltSetting& setting,
                                   const Task& task);

/// What plain tissue feels like in that session's condition, as Judgement has it: a mean over some
/// touches.
[[nodiscard]] double felt_plain(const FeltSession& session,
                                const Judgement& judgement,
                                std::uint64_t seed);

/// What comes of a search with that judgement.
struct FeltSearch {
  Place said{};
  FeltTrial felt{};
  double path{};  ///< [m]
};

/// Who searches goes over the area in rows, taps each place as often as the condition says, and
/// says the one that was the stiffest: a cell's middle, so that no ball is farther from the nearest
/// one than what counts as found. It ends where the time does. A guess anywhere in the area where
/// it lapses or nothing is felt.
[[nodiscard]] FeltSearch search(const FeltSession& session,
                                const SearchArea& area,
                                const TrialAsk& ask,
                                const Judgement& judgement,
                                std::uint64_t seed,
                                std::uint64_t stream);

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
  Task task_;
  SearchArea area_;
  PeopleTraits people_;
  std::vector<FeltSession> sessions_;  ///< of each condition
  std::vector<Judgement> judgements_;  ///< likewise, with the median Weber fraction
};

}  // namespace palp::study
