#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/core/place.h"
#include "common/core/time.h"

namespace palp::surgeon {

/// What a stretch of a script is for. Whoever judges a run finds its taps and holds by this.
enum class StretchKind : std::uint8_t {
  Hold,
  Air,  ///< sine in free air
  Move,
  Tap,    ///< there and back
  Pause,  ///< after a tap
  PressMove,
  PressHold,
  LiftMove,
  LiftHold,
  Travel,  ///< to another place, in the air
  Drag,    ///< to another place, pressed
  Replay   ///< recorded motion
};

/// One piece of motion with one formula.
struct Stretch {
  StretchKind kind{};
  std::uint32_t phase{};  ///< 1, 2, ...: the phase it belongs to
  std::uint32_t index{};  ///< of the tap in its phase, from 1; otherwise 0
  Duration began_at{};    ///< script time
  Duration duration{};
  double from{};       ///< [m], where it starts
  double to{};         ///< [m], end of a move, bottom of a tap, crest of a wave
  Place place{};       ///< where it starts
  Place to_place{};    ///< where it ends: another one in Travel and Drag
  double depth{};      ///< [m], aimed at in plain tissue: taps and presses; otherwise 0
  double frequency{};  ///< [Hz]: Air
  bool searches{};     ///< of a search: where it is, is decided as it begins
};

/// One line of a script: what a person would call one thing to do.
struct ScriptPhase {
  std::string name;
  Duration began_at{};  ///< script time
};

/// A recorded place of the hand.
struct ReplayPoint {
  Duration at{};      ///< script time
  double position{};  ///< [m]
  Place place{};
};

/// Where the hand wants to be.
struct Intent {
  double position{};  ///< [m], + into the tissue, 0 at the surface as the operator sees it
  double velocity{};  ///< [m/s]
  Place place{};
};

/// The intent of a scripted operator over script time, which starts at 0 and runs only while the
/// session does. Does not know hand, device or session. A value; thread: at() is rt-safe.
class GestureScript {
 public:
  /// The stretches follow each other without gaps from 0 on; at least one of positive length.
  GestureScript(std::vector<Stretch> stretches, std::vector<ScriptPhase> phases);
  /// A recorded motion, interpolated linearly: at least two points, `at` strictly rising from 0.
  explicit GestureScript(std::vector<ReplayPoint> points);
  /// The same with its taps and phases known; stretches as above, as long as the points. Such a
  /// motion has the tremor of its hand in it.
  GestureScript(std::vector<ReplayPoint> points,
                std::vector<Stretch> stretches,
                std::vector<ScriptPhase> phases);

  /// The travel of a search that `script_time` is in; nullptr: it is in none.
  [[nodiscard]] const Stretch* search_travel(Duration script_time) const noexcept;
  /// That travel goes to `place`, and what follows up to the next one is there.
  void turn_to(Duration script_time, const Place& place) noexcept;
  /// The search is over where that travel began. @returns the script time behind the search, of a
  /// travel from there.
  [[nodiscard]] Duration leave_search(Duration script_time) noexcept;

  /// Before 0 and after the end: the ends, at rest.
  [[nodiscard]] Intent at(Duration script_time) const noexcept;
  /// 1, 2, ...; before 0 and after the end: the first and the last.
  [[nodiscard]] std::uint32_t phase_at(Duration script_time) const noexcept;
  /// 1 <= `number` <= phases().size().
  [[nodiscard]] const ScriptPhase& phase(std::uint32_t number) const noexcept;

  [[nodiscard]] Duration length() const noexcept { return length_; }
  [[nodiscard]] bool has_tremor() const noexcept { return has_tremor_; }
  [[nodiscard]] std::span<const Stretch> stretches() const noexcept { return stretches_; }
  [[nodiscard]] std::span<const ScriptPhase> phases() const noexcept { return phases_; }
  /// The file that it was read from, for the session's record; empty: it is a ready-made one.
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  void set_text(std::string text) { text_ = std::move(text); }

 private:
  [[nodiscard]] const Stretch& stretch_at(Duration script_time) const noexcept;
  [[nodiscard]] Intent replayed_at(Duration script_time) const noexcept;

  std::vector<Stretch> stretches_;
  std::vector<ScriptPhase> phases_;
  std::vector<ReplayPoint> points_;
  std::string text_;
  Duration length_{};
  bool has_tremor_{};
};

}  // namespace palp::surgeon
