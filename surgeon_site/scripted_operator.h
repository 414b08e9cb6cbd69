#pragma once

#include <cstdint>

#include "common/core/time.h"
#include "surgeon_site/gesture_script.h"
#include "surgeon_site/haptic_device.h"

namespace palp::surgeon {

struct OperatorConfig {
  double surface_offset{};      ///< [m], where the operator sees the surface
  double start{-10e-3};         ///< [m] above that surface, where the hand waits at first
  double aligning_speed{0.03};  ///< [m/s], peak, towards the tip and to where the script begins
  double aligned_within{5e-5};  ///< [m], mismatch the operator accepts: about what an eye sees
  Duration settling{std::chrono::milliseconds{300}};  ///< still, before the pedal goes down
  Duration patience{std::chrono::milliseconds{100}};  ///< pedal down without an engagement
  Duration reaction{std::chrono::milliseconds{200}};  ///< from a session's end to the pedal up
  Duration pause{std::chrono::milliseconds{500}};     ///< between a refusal and the next try
  std::uint32_t attempts_max{20};                     ///< refusals in a row before giving up
  bool engage_again{true};                            ///< after the link was lost
};

/// The person of a run without persons: watches the session, brings the hand to the tip, presses
/// the pedal, performs the script, lets go. Gives an intent and a pedal; knows no force and no
/// mechanics. When the session breaks off it lets go of the pedal, waits until it can align again
/// and resumes at the beginning of the interrupted phase. Thread: rt (its device's).
class ScriptedOperator {
 public:
  ScriptedOperator(const OperatorConfig& config, GestureScript script);

  void see(const OperatorView& view) noexcept { view_ = view; }
  /// Lives `dt` onwards.
  void step(Duration dt) noexcept;

  [[nodiscard]] const Intent& intent() const noexcept { return intent_; }  ///< patient's axis
  [[nodiscard]] bool pedal_held() const noexcept { return pedal_held_; }
  [[nodiscard]] bool performing() const noexcept { return doing_ == Doing::Performing; }
  [[nodiscard]] Duration script_time() const noexcept { return script_time_; }
  [[nodiscard]] const GestureScript& script() const noexcept { return script_; }
  [[nodiscard]] ScriptProgress progress() const noexcept;

 private:
  enum class Doing : std::uint8_t {
    Waiting,
    Aligning,
    Settling,
    Pressing,
    Approaching,
    Performing,
    Pausing,
    Finished
  };

  /// Half a cosine from here to there, no faster than the aligning speed.
  class Move {
   public:
    void begin(double from, double to, double speed) noexcept;  ///< [m], [m], [m/s]
    void step(Duration dt) noexcept;
    [[nodiscard]] bool done() const noexcept { return elapsed_ >= duration_; }
    [[nodiscard]] double to() const noexcept { return to_; }  ///< [m]
    [[nodiscard]] double position() const noexcept;           ///< [m]
    [[nodiscard]] double velocity() const noexcept;           ///< [m/s]

   private:
    double from_{};  ///< [m]
    double to_{};    ///< [m]
    Duration elapsed_{};
    Duration duration_{};
  };

  [[nodiscard]] bool may_align() const noexcept;
  [[nodiscard]] bool session_runs() const noexcept;
  void begin(Doing next) noexcept;
  void begin_aligning() noexcept;
  void begin_approach() noexcept;
  void perform(Duration dt) noexcept;
  [[nodiscard]] bool waits_for_map() noexcept;
  void follow_move(Duration dt) noexcept;
  void break_off() noexcept;
  void try_again() noexcept;
  void finish(ScriptOutcome outcome) noexcept;

  OperatorConfig config_;
  GestureScript script_;
  OperatorView view_;
  Doing doing_{Doing::Waiting};
  Duration doing_for_{};
  Move move_;
  Intent intent_;
  Duration script_time_{};
  std::uint32_t attempts_{};  ///< refusals in a row
  std::uint32_t followed_{};  ///< number of the map that was obeyed last
  std::uint32_t decided_{};   ///< travel of a search whose place is decided
  Duration waited_{};         ///< for the next one
  bool pedal_held_{};
  ScriptOutcome outcome_{ScriptOutcome::None};
};

}  // namespace palp::surgeon
