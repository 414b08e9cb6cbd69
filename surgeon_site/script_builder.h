#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/time.h"
#include "surgeon_site/gesture_script.h"

namespace palp::surgeon {

inline constexpr double kClearPlace = -10e-3;  ///< [m], where scripts start and lift to
inline constexpr double kNearPlace = -3e-3;    ///< [m], from where taps begin
inline constexpr double kTravelSpeed = 0.1;    ///< [m/s], fastest of a hand along the surface

/// Force of plain tissue at `depth` [m] >= 0, as scripts assume it: 1897 d^1.5 [N], Hertz's law for
/// a sphere of 5 mm radius on an elastic half space of 15.3 kPa, Poisson's ratio 0.49.
[[nodiscard]] double plain_force(double depth) noexcept;

/// Where a search taps first, from its place: a triangle about as wide as inclusions are. From
/// three places on there is a map.
inline constexpr std::array kSearchFirst{Place{-7e-3, -4e-3}, Place{7e-3, -4e-3}, Place{0, 8e-3}};
/// How it taps: deeper and slower than the standard palpation, so that one tap tells the stiffness
/// of a place within 0.7 %. 4 mm within 1 s told it within 1.5 %, and took two or three taps more.
inline constexpr double kSearchDepth = 4.6e-3;  ///< [m]
inline constexpr Duration kSearchSpan = std::chrono::milliseconds{2000};

/// Puts a script together, phase by phase, from a hold of no length at -10 mm, site A.
/// Depths are what a hand of the given stiffness reaches on plain tissue: it aims at
/// d + plain_force(d)/stiffness, on every tissue alike, so a stiffer one gives less depth.
/// All spans must be > 0; ranges are the reader's to check. Not for rt: allocates.
class ScriptBuilder {
 public:
  explicit ScriptBuilder(double hand_stiffness);  ///< [N/m] > 0

  ScriptBuilder& hold(Duration span);
  /// Sine of `amplitude` [m] and `frequency` [Hz] about the present place.
  ScriptBuilder& air(double amplitude, double frequency, Duration span);
  ScriptBuilder& move(double position, Duration span);  ///< [m], half-cosine
  /// `count` raised cosines from here to `depth` [m] and back, each followed by a pause (0: none).
  ScriptBuilder& taps(std::uint32_t count, double depth, Duration span, Duration pause);
  ScriptBuilder& press(double depth, Duration move_span, Duration hold_span);  ///< depth [m]
  ScriptBuilder& lift(Duration move_span, Duration hold_span);
  /// The next phases are at `place`. Takes no time, so be clear of the tissue.
  ScriptBuilder& site(const Place& place);
  /// There at the present height, no faster than kTravelSpeed. Nothing where it is there already.
  ScriptBuilder& travel(const Place& place);
  ScriptBuilder& drag(const Place& place, Duration span);  ///< the same, pressed
  /// Taps until the map says that they are enough, `count` at most (3 or more), each where it
  /// proposes; the first three round `place`. Then back there.
  ScriptBuilder& search(std::uint32_t count, const Place& place);

  [[nodiscard]] double position() const noexcept { return position_; }  ///< [m], after all so far
  [[nodiscard]] Place place() const noexcept { return place_; }         ///< likewise
  [[nodiscard]] Duration length() const noexcept { return length_; }
  [[nodiscard]] GestureScript build() const;  ///< at least one phase was added

 private:
  [[nodiscard]] double aim_for(double depth) const noexcept;
  void begin_phase(std::string name);
  /// Fills in phase, time and place, and goes to where the stretch ends.
  void append(Stretch stretch);
  void hold_as(StretchKind kind, Duration span);
  void glide_as(StretchKind kind, const Place& to, Duration span);
  void move_as(StretchKind kind, double to, Duration span, double depth = 0);

  double hand_stiffness_;         ///< [N/m]
  double position_{kClearPlace};  ///< [m]
  Place place_{kSiteA};
  Duration length_{};
  std::vector<Stretch> stretches_;
  std::vector<ScriptPhase> phases_;
};

/// What a ready-made script is made for.
struct ScriptSetting {
  double hand_stiffness{300.0};  ///< [N/m], of the grip
  Duration round_trip{};         ///< expected; lengthens the holds of `standard`
};

/// The standard palpation: a hold, 4 s of free air, then on site A and on site B four taps to 4 mm,
/// presses held at 2 and 4 mm, and a lift. Every hold lasts max(2 s, 4 round trips).
[[nodiscard]] GestureScript standard_script(const ScriptSetting& setting);

/// The same taps on both sites and one held press to 4 mm each, in 25 s.
[[nodiscard]] GestureScript demo_script(const ScriptSetting& setting);

/// One tap at each of nine places round B, three by three, 10 mm apart, in 25 s.
[[nodiscard]] GestureScript map_script(const ScriptSetting& setting);

/// A search of 20 taps at most, from B.
[[nodiscard]] GestureScript search_script(const ScriptSetting& setting);

/// `standard` with holds of 10 s: the last 40 % of them are a whole breath at 0.25 Hz.
[[nodiscard]] GestureScript breath_script(const ScriptSetting& setting);

/// Ten minutes of free air and taps in turn on both sites, and a last lift.
[[nodiscard]] GestureScript long_script(const ScriptSetting& setting);

}  // namespace palp::surgeon
