// Input: the text of a script; the same text as a recorded hand.
#include <cmath>

#include "common/core/check.h"
#include "surgeon_site/script_reader.h"
#include "tests/fuzz/fuzz.h"

namespace palp::surgeon {
namespace {

constexpr double kHandStiffness = 300;  // [N/m]
constexpr double kPlaceMin = -60e-3;    // [m], as the reader allows
constexpr double kPlaceMax = 40e-3;     // [m], aimed at for 20 mm of plain tissue
constexpr double kReachMax = 200e-3;    // [m]
constexpr double kRounding = 1e-9;      // [m]
constexpr double kStepMax = 1e-6;       // [m] in a nanosecond: a jump
constexpr Duration kNanosecond{1};
constexpr Duration kLengthMax{std::chrono::hours{6}};  // 4 h and a line that began before

bool between(double value, double low, double high) {
  return value >= low - kRounding && value <= high + kRounding;
}

Intent sound_intent(const GestureScript& script, Duration at) {
  const Intent intent = script.at(at);
  PALP_CHECK(between(intent.position, kPlaceMin, kPlaceMax), "the hand stays in reach");
  PALP_CHECK(between(intent.place.x, -kReachMax, kReachMax) &&
                 between(intent.place.y, -kReachMax, kReachMax),
             "the hand stays in reach");
  PALP_CHECK(std::isfinite(intent.velocity), "the hand has a speed");
  const std::uint32_t phase = script.phase_at(at);
  PALP_CHECK(phase >= 1 && phase <= script.phases().size(), "each instant has its phase");
  return intent;
}

void common_laws(const GestureScript& script) {
  PALP_CHECK(script.length() > Duration{0} && script.length() < kLengthMax, "a script has an end");
  for (const Duration outside :
       {-kNanosecond, script.length() + kNanosecond, Duration::max() / 2}) {
    PALP_CHECK(sound_intent(script, outside).velocity == 0, "at rest before and after");
  }
  constexpr int kSteps = 64;
  std::uint32_t phase = 1;
  for (int i = 0; i <= kSteps; ++i) {
    const Duration at = script.length() / kSteps * i;
    sound_intent(script, at);
    PALP_CHECK(script.phase_at(at) >= phase, "phases follow each other");
    phase = script.phase_at(at);
  }
}

void stretch_laws(const GestureScript& script) {
  Duration end{};
  std::uint32_t phase = 1;
  std::size_t looked_at = 0;
  for (const Stretch& stretch : script.stretches()) {
    PALP_CHECK(stretch.began_at == end && stretch.duration > Duration{0}, "there are no gaps");
    PALP_CHECK(stretch.phase >= phase && stretch.phase <= script.phases().size(), "a known phase");
    end = stretch.began_at + stretch.duration;
    phase = stretch.phase;
    if (++looked_at > 1000) continue;
    const Intent before = sound_intent(script, stretch.began_at - kNanosecond);
    const Intent after = sound_intent(script, stretch.began_at);
    PALP_CHECK(std::abs(after.position - before.position) < kStepMax, "the hand never jumps");
  }
  PALP_CHECK(end == script.length(), "the last stretch ends the script");
}

}  // namespace
}  // namespace palp::surgeon

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = palp::fuzz::as_text(data, size);
  if (const auto script = palp::surgeon::parse_script(text, palp::surgeon::kHandStiffness)) {
    palp::surgeon::common_laws(*script);
    palp::surgeon::stretch_laws(*script);
  } else {
    PALP_CHECK(!script.error().text.empty(), "a refusal says why");
  }
  if (const auto replay = palp::surgeon::parse_replay(text)) {
    palp::surgeon::common_laws(*replay);
  } else {
    PALP_CHECK(!replay.error().text.empty(), "a refusal says why");
  }
  return 0;
}
