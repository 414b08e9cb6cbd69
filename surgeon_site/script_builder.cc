#include "surgeon_site/script_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/place_text.h"

namespace palp::surgeon {
namespace {

using std::chrono::milliseconds;

constexpr Duration kTravelMin = milliseconds{100};
constexpr double kHertz = 1897.0;  ///< [N/m^1.5], see plain_force

std::string millimetres(double length) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g mm", length / kMillimetre);
  return text.data();
}

void palpate(ScriptBuilder& script, Duration hold) {
  script.move(kNearPlace, milliseconds{500})
      .taps(4, 4e-3, milliseconds{1000}, milliseconds{500})
      .press(2e-3, milliseconds{600}, hold)
      .press(4e-3, milliseconds{400}, hold)
      .lift(milliseconds{600}, hold);
}

void palpate_briefly(ScriptBuilder& script) {
  script.move(kNearPlace, milliseconds{500})
      .taps(4, 4e-3, milliseconds{1000}, milliseconds{500})
      .press(4e-3, milliseconds{600}, milliseconds{2000})
      .lift(milliseconds{600}, milliseconds{1000});
}

}  // namespace

double plain_force(double depth) noexcept { return kHertz * depth * std::sqrt(depth); }

ScriptBuilder::ScriptBuilder(double hand_stiffness) : hand_stiffness_{hand_stiffness} {
  PALP_CHECK(hand_stiffness > 0, "a hand without stiffness cannot aim");
}

double ScriptBuilder::aim_for(double depth) const noexcept {
  return depth + plain_force(depth) / hand_stiffness_;
}

void ScriptBuilder::begin_phase(std::string name) { phases_.push_back({std::move(name), length_}); }

void ScriptBuilder::append(Stretch stretch) {
  stretch.phase = static_cast<std::uint32_t>(phases_.size());
  stretch.began_at = length_;
  stretch.from = position_;
  stretch.place = place_;
  if (stretch.kind != StretchKind::Travel && stretch.kind != StretchKind::Drag) {
    stretch.to_place = place_;
  }
  length_ += stretch.duration;
  stretches_.push_back(stretch);
}

void ScriptBuilder::hold_as(StretchKind kind, Duration span) {
  Stretch stretch;
  stretch.kind = kind;
  stretch.duration = span;
  stretch.to = position_;
  append(stretch);
}

void ScriptBuilder::move_as(StretchKind kind, double to, Duration span, double depth) {
  Stretch stretch;
  stretch.kind = kind;
  stretch.duration = span;
  stretch.to = to;
  stretch.depth = depth;
  append(stretch);
  position_ = to;
}

ScriptBuilder& ScriptBuilder::hold(Duration span) {
  begin_phase("hold");
  hold_as(StretchKind::Hold, span);
  return *this;
}

ScriptBuilder& ScriptBuilder::air(double amplitude, double frequency, Duration span) {
  begin_phase("free air");
  Stretch stretch;
  stretch.kind = StretchKind::Air;
  stretch.duration = span;
  stretch.to = position_ + amplitude;
  stretch.frequency = frequency;
  append(stretch);
  return *this;
}

ScriptBuilder& ScriptBuilder::move(double position, Duration span) {
  begin_phase("move " + place_text(place_));
  move_as(StretchKind::Move, position, span);
  return *this;
}

ScriptBuilder& ScriptBuilder::taps(std::uint32_t count,
                                   double depth,
                                   Duration span,
                                   Duration pause) {
  begin_phase("taps " + place_text(place_));
  for (std::uint32_t index = 1; index <= count; ++index) {
    Stretch tap;
    tap.kind = StretchKind::Tap;
    tap.index = index;
    tap.duration = span;
    tap.to = aim_for(depth);
    tap.depth = depth;
    append(tap);
    if (pause > Duration{0}) hold_as(StretchKind::Pause, pause);
  }
  return *this;
}

ScriptBuilder& ScriptBuilder::press(double depth, Duration move_span, Duration hold_span) {
  begin_phase("press " + millimetres(depth) + " " + place_text(place_));
  move_as(StretchKind::PressMove, aim_for(depth), move_span, depth);
  hold_as(StretchKind::PressHold, hold_span);
  stretches_.back().depth = depth;
  return *this;
}

ScriptBuilder& ScriptBuilder::lift(Duration move_span, Duration hold_span) {
  begin_phase("lift " + place_text(place_));
  move_as(StretchKind::LiftMove, kClearPlace, move_span);
  hold_as(StretchKind::LiftHold, hold_span);
  return *this;
}

ScriptBuilder& ScriptBuilder::site(const Place& place) {
  place_ = place;
  return *this;
}

void ScriptBuilder::glide_as(StretchKind kind, const Place& to, Duration span) {
  Stretch stretch;
  stretch.kind = kind;
  stretch.duration = span;
  stretch.to = position_;
  stretch.to_place = to;
  append(stretch);
  place_ = to;
}

ScriptBuilder& ScriptBuilder::travel(const Place& place) {
  if (place == place_) return *this;
  begin_phase("to " + place_text(place));
  // A half cosine peaks at pi/2 times its mean speed.
  const double time = std::numbers::pi / 2 * distance(place, place_) / kTravelSpeed;
  glide_as(StretchKind::Travel, place, std::max<Duration>(kTravelMin, from_seconds(time)));
  return *this;
}

ScriptBuilder& ScriptBuilder::drag(const Place& place, Duration span) {
  begin_phase("drag to " + place_text(place));
  glide_as(StretchKind::Drag, place, span);
  return *this;
}

ScriptBuilder& ScriptBuilder::search(std::uint32_t count, const Place& place) {
  constexpr Duration kLeg = milliseconds{1000};  // of 60 mm at kTravelSpeed
  if (position_ != kNearPlace) move(kNearPlace, milliseconds{500});
  for (std::uint32_t i = 0; i < count; ++i) {
    const Place& first = kSearchFirst[i % kSearchFirst.size()];
    const Place to{place.x + first.x, place.y + first.y};
    begin_phase("search, tap " + std::to_string(i + 1));
    glide_as(StretchKind::Travel, to, kLeg);
    stretches_.back().searches = true;
    stretches_.back().index = i + 1;
    Stretch tap;
    tap.kind = StretchKind::Tap;
    tap.index = 1;
    tap.duration = kSearchSpan;
    tap.to = aim_for(kSearchDepth);
    tap.depth = kSearchDepth;
    tap.searches = true;
    append(tap);
    hold_as(StretchKind::Pause, milliseconds{500});
    stretches_.back().searches = true;
  }
  begin_phase("to " + place_text(place));
  glide_as(StretchKind::Travel, place, kLeg);
  return *this;
}

GestureScript ScriptBuilder::build() const { return GestureScript{stretches_, phases_}; }

GestureScript standard_script(const ScriptSetting& setting) {
  const Duration hold = std::max<Duration>(milliseconds{2000}, 4 * setting.round_trip);
  ScriptBuilder script{setting.hand_stiffness};
  script.hold(milliseconds{1000}).air(5e-3, 1.0, milliseconds{4000}).hold(milliseconds{500});
  palpate(script.site(kSiteA), hold);
  palpate(script.site(kSiteB), hold);
  return script.build();
}

GestureScript breath_script(const ScriptSetting& setting) {
  // 40 % of 10 s is one breath at 0.25 Hz.
  const Duration hold = std::chrono::seconds{10};
  ScriptBuilder script{setting.hand_stiffness};
  script.hold(milliseconds{1000}).air(5e-3, 1.0, milliseconds{4000}).hold(milliseconds{500});
  palpate(script.site(kSiteA), hold);
  palpate(script.site(kSiteB), hold);
  return script.build();
}

GestureScript long_script(const ScriptSetting& setting) {
  ScriptBuilder script{setting.hand_stiffness};
  while (script.length() < std::chrono::minutes{10}) {
    for (const Place& site : {kSiteA, kSiteB}) {
      script.site(site).air(5e-3, 1.0, milliseconds{4000});
      script.move(kNearPlace, milliseconds{500})
          .taps(4, 4e-3, milliseconds{1000}, milliseconds{500});
      script.lift(milliseconds{600}, milliseconds{2000});
    }
  }
  return script.build();
}

GestureScript map_script(const ScriptSetting& setting) {
  constexpr double kPitch =
      10e-3;  // [m]: apart enough to tell size from depth, near enough to meet
  ScriptBuilder script{setting.hand_stiffness};
  script.hold(milliseconds{1000});
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const int along = row % 2 == 0 ? -column : column;  // to and fro
      script.travel({kSiteB.x + along * kPitch, kSiteB.y + row * kPitch});
      if (script.position() != kNearPlace) script.move(kNearPlace, milliseconds{500});
      script.taps(1, 4e-3, milliseconds{1000}, milliseconds{500});
    }
  }
  script.lift(milliseconds{600}, milliseconds{500});
  return script.build();
}

GestureScript search_script(const ScriptSetting& setting) {
  ScriptBuilder script{setting.hand_stiffness};
  script.hold(milliseconds{1000}).search(20, kSiteB).lift(milliseconds{600}, milliseconds{500});
  return script.build();
}

GestureScript demo_script(const ScriptSetting& setting) {
  ScriptBuilder script{setting.hand_stiffness};
  script.hold(milliseconds{1000}).air(5e-3, 1.0, milliseconds{2000}).hold(milliseconds{500});
  palpate_briefly(script.site(kSiteA));
  palpate_briefly(script.site(kSiteB));
  return script.build();
}

}  // namespace palp::surgeon
