#include "surgeon_site/gesture_script.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/core/check.h"

namespace palp::surgeon {
namespace {

using std::numbers::pi;

/// Half a cosine from `from` to `to`: at rest at both ends.
Intent half_cosine(const Stretch& stretch, double elapsed) noexcept {
  const double duration = seconds(stretch.duration);
  const double angle = pi * elapsed / duration;
  const double way = stretch.to - stretch.from;
  return {stretch.from + way * (1 - std::cos(angle)) / 2,
          way * pi / (2 * duration) * std::sin(angle),
          stretch.place};
}

/// Raised cosine: from `from` to `to` and back.
Intent raised_cosine(const Stretch& stretch, double elapsed) noexcept {
  const double duration = seconds(stretch.duration);
  const double angle = 2 * pi * elapsed / duration;
  const double way = stretch.to - stretch.from;
  return {stretch.from + way * (1 - std::cos(angle)) / 2,
          way * pi / duration * std::sin(angle),
          stretch.place};
}

Intent sine(const Stretch& stretch, double elapsed) noexcept {
  const double turn = 2 * pi * stretch.frequency;
  const double amplitude = stretch.to - stretch.from;
  return {stretch.from + amplitude * std::sin(turn * elapsed),
          amplitude * turn * std::cos(turn * elapsed),
          stretch.place};
}

/// Half a cosine along the surface, at one height.
Intent glide(const Stretch& stretch, double elapsed) noexcept {
  const double share = (1 - std::cos(pi * elapsed / seconds(stretch.duration))) / 2;
  return {stretch.from, 0, between(stretch.place, stretch.to_place, share)};
}

Intent position_in(const Stretch& stretch, double elapsed) noexcept {
  switch (stretch.kind) {
    case StretchKind::Move:
    case StretchKind::PressMove:
    case StretchKind::LiftMove:
      return half_cosine(stretch, elapsed);
    case StretchKind::Tap:
      return raised_cosine(stretch, elapsed);
    case StretchKind::Air:
      return sine(stretch, elapsed);
    case StretchKind::Travel:
    case StretchKind::Drag:
      return glide(stretch, elapsed);
    case StretchKind::Hold:
    case StretchKind::Pause:
    case StretchKind::PressHold:
    case StretchKind::LiftHold:
    case StretchKind::Replay:
      break;
  }
  return {stretch.from, 0, stretch.place};
}

}  // namespace

GestureScript::GestureScript(std::vector<Stretch> stretches, std::vector<ScriptPhase> phases)
    : stretches_{std::move(stretches)}, phases_{std::move(phases)} {
  for (const Stretch& stretch : stretches_) {
    PALP_CHECK(stretch.began_at == length_ && stretch.duration > Duration{0},
               "stretches follow each other without gaps");
    PALP_CHECK(stretch.phase >= 1 && stretch.phase <= phases_.size(), "a stretch has its phase");
    length_ += stretch.duration;
  }
  PALP_CHECK(!stretches_.empty(), "a script has at least one stretch");
}

GestureScript::GestureScript(std::vector<ReplayPoint> points)
    : phases_{{"replay", Duration{0}}}, points_{std::move(points)} {
  PALP_CHECK(points_.size() >= 2 && points_.front().at == Duration{0},
             "a replay has two points or more, the first at 0");
  for (std::size_t i = 1; i < points_.size(); ++i) {
    PALP_CHECK(points_[i].at > points_[i - 1].at, "the times of a replay rise strictly");
  }
  length_ = points_.back().at;
  Stretch whole;
  whole.kind = StretchKind::Replay;
  whole.phase = 1;
  whole.duration = length_;
  whole.from = points_.front().position;
  whole.to = points_.back().position;
  whole.place = points_.front().place;
  whole.to_place = points_.back().place;
  stretches_.push_back(whole);
}

GestureScript::GestureScript(std::vector<ReplayPoint> points,
                             std::vector<Stretch> stretches,
                             std::vector<ScriptPhase> phases)
    : GestureScript{std::move(stretches), std::move(phases)} {
  GestureScript motion{std::move(points)};
  PALP_CHECK(motion.length_ == length_, "the stretches are as long as the motion");
  points_ = std::move(motion.points_);
  has_tremor_ = true;
}

const Stretch& GestureScript::stretch_at(Duration script_time) const noexcept {
  const auto next = std::upper_bound(
      stretches_.begin() + 1, stretches_.end(), script_time, [](Duration at, const Stretch& s) {
        return at < s.began_at;
      });
  return *(next - 1);
}

const Stretch* GestureScript::search_travel(Duration script_time) const noexcept {
  const Stretch& stretch = stretch_at(script_time);
  return stretch.searches && stretch.kind == StretchKind::Travel ? &stretch : nullptr;
}

void GestureScript::turn_to(Duration script_time, const Place& place) noexcept {
  auto stretch = stretches_.begin() + (&stretch_at(script_time) - stretches_.data());
  stretch->to_place = place;
  for (++stretch; stretch != stretches_.end(); ++stretch) {
    stretch->place = place;
    if (stretch->kind == StretchKind::Travel) return;
    stretch->to_place = place;
  }
}

Duration GestureScript::leave_search(Duration script_time) noexcept {
  auto stretch = stretches_.begin() + (&stretch_at(script_time) - stretches_.data());
  const Place here = stretch->place;
  while (stretch != stretches_.end() && stretch->searches) ++stretch;
  if (stretch == stretches_.end()) return length_;
  stretch->place = here;
  return stretch->began_at;
}

Intent GestureScript::at(Duration script_time) const noexcept {
  const Duration inside = std::clamp(script_time, Duration{0}, length_);
  Intent intent;
  if (!points_.empty()) {
    intent = replayed_at(inside);
  } else {
    const Stretch& stretch = stretch_at(inside);
    intent = position_in(stretch, seconds(inside - stretch.began_at));
  }
  if (script_time < Duration{0} || script_time >= length_) intent.velocity = 0;
  return intent;
}

Intent GestureScript::replayed_at(Duration script_time) const noexcept {
  const auto next = std::upper_bound(
      points_.begin() + 1, points_.end() - 1, script_time, [](Duration at, const ReplayPoint& p) {
        return at < p.at;
      });
  const ReplayPoint& right = *next;
  const ReplayPoint& left = *(next - 1);
  const double span = seconds(right.at - left.at);
  const double share = seconds(script_time - left.at) / span;
  return {left.position + share * (right.position - left.position),
          (right.position - left.position) / span,
          between(left.place, right.place, share)};
}

std::uint32_t GestureScript::phase_at(Duration script_time) const noexcept {
  return stretch_at(script_time).phase;
}

const ScriptPhase& GestureScript::phase(std::uint32_t number) const noexcept {
  PALP_CHECK(number >= 1 && number <= phases_.size(), "phases are numbered from 1");
  return phases_[number - 1];
}

}  // namespace palp::surgeon
