#include "surgeon_site/scripted_operator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "common/core/check.h"

namespace palp::surgeon {
namespace {

using std::numbers::pi;

/// The shortest move: a hand does not jerk for a hair's breadth.
constexpr Duration kMoveMin = std::chrono::milliseconds{100};
/// The patient site's refusal is a round trip away, and no round trip is longer than this.
constexpr Duration kAcceptedAfter = std::chrono::seconds{3};
/// So many taps of a search come before there is a map.
constexpr std::uint32_t kSearchBlind = 3;
/// What a person waits for news of the last tap.
constexpr Duration kMapPatience = std::chrono::seconds{4};

}  // namespace

void ScriptedOperator::Move::begin(double from, double to, double speed) noexcept {
  from_ = from;
  to_ = to;
  elapsed_ = Duration{0};
  duration_ = Duration{0};
  // A half cosine peaks at pi/2 times its mean speed.
  if (to != from) {
    duration_ = std::max(kMoveMin, from_seconds(pi / 2 * std::abs(to - from) / speed));
  }
}

void ScriptedOperator::Move::step(Duration dt) noexcept {
  elapsed_ = std::min(elapsed_ + dt, duration_);
}

double ScriptedOperator::Move::position() const noexcept {
  if (done()) return to_;
  const double share = seconds(elapsed_) / seconds(duration_);
  return from_ + (to_ - from_) * (1 - std::cos(pi * share)) / 2;
}

double ScriptedOperator::Move::velocity() const noexcept {
  if (done()) return 0;
  const double duration = seconds(duration_);
  return (to_ - from_) * pi / (2 * duration) * std::sin(pi * seconds(elapsed_) / duration);
}

ScriptedOperator::ScriptedOperator(const OperatorConfig& config, GestureScript script)
    : config_{config}, script_{std::move(script)} {
  PALP_CHECK(config.aligning_speed > 0, "an operator who never moves never aligns");
  intent_.position = config.surface_offset + config.start;
  intent_.place = script_.at(Duration{0}).place;
}

bool ScriptedOperator::may_align() const noexcept {
  return view_.state == SiteState::Clutched && view_.peer_state == SiteState::Clutched &&
         view_.link == LinkState::Live && view_.tip_known;
}

bool ScriptedOperator::session_runs() const noexcept {
  return view_.state == SiteState::Engaged || view_.state == SiteState::Hold;
}

void ScriptedOperator::begin(Doing next) noexcept {
  doing_ = next;
  doing_for_ = Duration{0};
}

void ScriptedOperator::begin_aligning() noexcept {
  move_.begin(intent_.position, view_.tip_position, config_.aligning_speed);
  intent_.place = script_.at(script_time_).place;
  begin(Doing::Aligning);
}

void ScriptedOperator::begin_approach() noexcept {
  const Intent first = script_.at(script_time_);
  move_.begin(intent_.position, config_.surface_offset + first.position, config_.aligning_speed);
  intent_.place = first.place;
  begin(Doing::Approaching);
}

void ScriptedOperator::follow_move(Duration dt) noexcept {
  move_.step(dt);
  intent_.position = move_.position();
  intent_.velocity = move_.velocity();
}

/// At the beginning of a search's travel: the person looks at the map, and goes where it proposes.
/// The news of the last tap is a round trip away.
bool ScriptedOperator::waits_for_map() noexcept {
  const Stretch* const travel = script_.search_travel(script_time_);
  if (travel == nullptr || travel->index <= kSearchBlind || travel->index == decided_) return false;
  const bool news = view_.map != followed_;
  if (!news && waited_ < kMapPatience) return true;
  decided_ = travel->index;
  waited_ = Duration{0};
  followed_ = view_.map;
  if (view_.map == 0) return false;
  if (view_.enough_touches) {
    script_time_ = script_.leave_search(script_time_);
  } else {
    script_.turn_to(script_time_, view_.next);
  }
  return false;
}

void ScriptedOperator::perform(Duration dt) noexcept {
  if (waits_for_map()) {
    waited_ += dt;
    return;
  }
  script_time_ += dt;
  intent_ = script_.at(script_time_);
  intent_.position += config_.surface_offset;
  if (doing_for_ > kAcceptedAfter) attempts_ = 0;
  if (script_time_ < script_.length()) return;
  script_time_ = script_.length();
  finish(ScriptOutcome::Completed);
}

void ScriptedOperator::break_off() noexcept {
  if (doing_ == Doing::Performing) {
    script_time_ = script_.phase(script_.phase_at(script_time_)).began_at;
  }
  intent_.velocity = 0;
  // Back in Clutched with the link alive: the patient site did not follow, or let go.
  if (view_.state == SiteState::Clutched) return try_again();
  if (!config_.engage_again) return finish(ScriptOutcome::Interrupted);
  begin(Doing::Pausing);
}

void ScriptedOperator::try_again() noexcept {
  pedal_held_ = false;
  if (++attempts_ >= config_.attempts_max) return finish(ScriptOutcome::Refused);
  begin(Doing::Pausing);
}

void ScriptedOperator::finish(ScriptOutcome outcome) noexcept {
  pedal_held_ = false;
  intent_.velocity = 0;
  outcome_ = outcome;
  begin(Doing::Finished);
}

void ScriptedOperator::step(Duration dt) noexcept {
  if (doing_ == Doing::Finished) return;
  if (view_.state == SiteState::Stopped) return finish(ScriptOutcome::Stopped);
  doing_for_ += dt;
  switch (doing_) {
    case Doing::Waiting:
      if (may_align()) begin_aligning();
      break;
    case Doing::Aligning:
      follow_move(dt);
      if (move_.done()) begin(may_align() ? Doing::Settling : Doing::Waiting);
      break;
    case Doing::Settling:
      if (!may_align()) {
        begin(Doing::Waiting);
      } else if (std::abs(view_.tip_position - move_.to()) > config_.aligned_within) {
        begin_aligning();
      } else if (doing_for_ >= config_.settling) {
        pedal_held_ = true;
        begin(Doing::Pressing);
      }
      break;
    case Doing::Pressing:
      if (session_runs()) {
        begin_approach();
      } else if (doing_for_ >= config_.patience) {
        try_again();
      }
      break;
    case Doing::Approaching:
      if (!session_runs()) return break_off();
      follow_move(dt);
      if (move_.done()) begin(Doing::Performing);
      break;
    case Doing::Performing:
      if (!session_runs()) return break_off();
      perform(dt);
      break;
    case Doing::Pausing:
      if (doing_for_ >= config_.reaction) pedal_held_ = false;
      if (doing_for_ >= config_.pause) begin(Doing::Waiting);
      break;
    case Doing::Finished:
      break;
  }
}

ScriptProgress ScriptedOperator::progress() const noexcept {
  ScriptProgress progress;
  progress.scripted = true;
  progress.begun = doing_ == Doing::Performing || script_time_ > Duration{0};
  progress.finished = doing_ == Doing::Finished;
  progress.outcome = outcome_;
  progress.done = seconds(script_time_) / seconds(script_.length());
  progress.phase = script_.phase_at(script_time_);
  const std::string& name = script_.phase(progress.phase).name;
  const std::size_t length = std::min(name.size(), progress.phase_name.size() - 1);
  std::memcpy(progress.phase_name.data(), name.data(), length);
  return progress;
}

}  // namespace palp::surgeon
