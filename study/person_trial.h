#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/core/place.h"
#include "common/core/time.h"
#include "study/trial.h"
#include "study/trial_row.h"

namespace palp::study {

/// What the surgeon's site says of itself.
struct SiteNews {
  bool engaged{};          ///< pedal held, and both sites follow the hand
  double force{};          ///< [N], to the hand
  double contact_force{};  ///< [N], of the tip, as last heard
  Place stands{};          ///< of the stage, as last heard
};

/// Where the stage is to stand.
struct StagePlace {
  Place place{};
  double reach{};  ///< [m], to all sides, by which the hand may leave it; 0: it stays there
  friend bool operator==(const StagePlace&, const StagePlace&) = default;
};

/// What is searched for.
struct HiddenAxis {
  Place axis{};
  double reach{};   ///< [m], of the area to all sides of where the search begins
  double within{};  ///< [m], of the axis: found
};

/// A trial as it is to be given at real sites.
struct PersonTrialPlan {
  std::vector<Place> places{};  ///< of each interval
  std::size_t choices{2};       ///< answers there are
  Place decoy{};                ///< by way of which the stage travels
  int taps{1};
  bool practice{};
  TrialTimes times{};
  std::optional<HiddenAxis> hidden{};  ///< a search; `places` is the middle of its area
};

/// What a participant is asked to do.
enum class PersonStage : std::uint8_t {
  Press,   ///< the pedal, and hold it
  Lift,    ///< out of the tissue, before the stage travels
  Travel,  ///< wait: the stage travels
  Touch,   ///< tap
  Answer,  ///< the pedal may be let go
  Told,    ///< practice: whether it was right
  Done,
};

/// Why a trial began anew.
enum class PersonNotice : std::uint8_t {
  None,
  LetGo,      ///< the pedal came up, or a site did
  HeldUp,     ///< the stage did not come to its place in time
  Untouched,  ///< a search in which the tissue was never touched
};

/// A trial at real sites: waits until the hand is engaged and clear of the tissue, goes through a
/// Trial, and begins it anew as often as it came to nothing. Moves in tick(now) alone. A value.
class PersonTrial {
 public:
  explicit PersonTrial(PersonTrialPlan plan) : plan_{std::move(plan)} {}

  /// `now` does not go back. `answer`: the interval that was chosen since the tick before, from 0.
  void tick(TimePoint now, const SiteNews& news, std::optional<std::size_t> answer);

  [[nodiscard]] PersonStage stage() const noexcept { return stage_; }
  [[nodiscard]] PersonNotice notice() const noexcept { return notice_; }
  /// From 0: the one touched now, or travelled to.
  [[nodiscard]] std::size_t interval() const noexcept { return trial_ ? trial_->interval() : 0; }
  /// Where the stage is to stand; nothing: wherever it stands.
  [[nodiscard]] std::optional<StagePlace> place() const noexcept { return place_; }
  /// An answer would count now.
  [[nodiscard]] bool asks() const noexcept {
    return stage_ == PersonStage::Answer || (stage_ == PersonStage::Touch && plan_.hidden);
  }
  [[nodiscard]] int taps_wanted() const noexcept { return plan_.taps; }  ///< of an interval
  /// How often it was begun.
  [[nodiscard]] std::size_t attempts() const noexcept { return attempts_; }
  /// stage() is Told or Done. From the first tick on, all attempts and waiting for them included,
  /// to `now`; taps, force and contact are of the last attempt.
  [[nodiscard]] TrialOutcome outcome(TimePoint now) const;

 private:
  void begin_anew(PersonNotice why) noexcept;
  void step(TimePoint now, const SiteNews& news, std::optional<std::size_t> answer);
  void follow(const SiteNews& news) noexcept;
  [[nodiscard]] bool touches(TimePoint now, double force) noexcept;

  PersonTrialPlan plan_;
  std::optional<Trial> trial_;  ///< under way
  std::optional<TimePoint> offered_at_;
  PersonStage stage_{PersonStage::Press};
  PersonNotice notice_{PersonNotice::None};
  std::optional<StagePlace> place_;
  // Of a search.
  std::optional<Place> stood_;  ///< a tick before
  double path_{};               ///< [m]
  double force_sum_{};          ///< [N], sum over the ticks in contact
  std::size_t force_ticks_{};   ///< those
  std::size_t attempts_{};
  bool touching_{};
  TimePoint touched_at_{};  ///< last
};

}  // namespace palp::study
