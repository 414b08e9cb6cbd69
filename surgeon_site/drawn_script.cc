#include "surgeon_site/drawn_script.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/conventions.h"
#include "common/core/random.h"

namespace palp::surgeon {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kScriptDraws = 0x6472'6177'6e73'6372ULL;  // "drawnscr"
constexpr int kGestures = 6;

class GestureDraws {
 public:
  explicit GestureDraws(std::uint64_t seed) : stream_{seed, kScriptDraws} {}
  double between(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  Duration span(double low, double high) { return from_seconds(between(low, high)); }
  std::uint32_t count(std::uint32_t low, std::uint32_t high) {
    return low + static_cast<std::uint32_t>((high - low + 1) * stream_.uniform(next_++));
  }
  bool heads() { return stream_.uniform(next_++) < 0.5; }

 private:
  RandomStream stream_;
  std::uint64_t next_{};
};

double drawn_depth(GestureDraws& draws) { return draws.between(1, 5) * kMillimetre; }

void add_lift(ScriptBuilder& script, GestureDraws& draws) {
  script.lift(draws.span(0.3, 1), milliseconds{1500});
}

void add_tap(ScriptBuilder& script, GestureDraws& draws) {
  const Duration pause = draws.heads() ? draws.span(0.05, 0.5) : Duration{0};
  const double depth = drawn_depth(draws);
  const double rate = draws.between(1, 5);  // [Hz]
  script.move(kNearPlace, milliseconds{400});
  script.taps(draws.count(2, 6), depth, from_seconds(1 / rate), pause);
  add_lift(script, draws);
}

void add_press(ScriptBuilder& script, GestureDraws& draws) {
  const Duration hold = draws.count(1, 6) == 1 ? std::chrono::seconds{20} : draws.span(2, 6);
  script.press(drawn_depth(draws), draws.span(0.3, 1.5), hold);
  add_lift(script, draws);
}

void add_creep(ScriptBuilder& script, GestureDraws& draws) {
  script.move(-kMillimetre, milliseconds{500});
  script.press(drawn_depth(draws), draws.span(3, 8), draws.span(2, 4));
  add_lift(script, draws);
}

void add_tap_from_within(ScriptBuilder& script, GestureDraws& draws) {
  const double depth = draws.between(1, 2.5) * kMillimetre;
  script.press(depth, draws.span(0.4, 1), draws.span(1.5, 3));
  script.taps(draws.count(2, 6),
              depth + draws.between(0.5, 2.5) * kMillimetre,
              from_seconds(1 / draws.between(0.5, 3)),
              Duration{0});
  add_lift(script, draws);
}

void add_drag(ScriptBuilder& script, GestureDraws& draws) {
  const Place to = script.place() == kSiteA ? kSiteB : kSiteA;
  const double speed = draws.between(5, 30) * kMillimetre;  // [m/s]
  script.press(draws.between(1, 3) * kMillimetre, draws.span(0.4, 1), draws.span(1.5, 4));
  script.drag(to, from_seconds(distance(script.place(), to) / speed));
  add_lift(script, draws);
}

}  // namespace

GestureScript drawn_script(std::uint64_t seed, const ScriptSetting& setting) {
  constexpr std::array kAll{add_tap, add_press, add_creep, add_tap_from_within, add_drag};
  GestureDraws draws{seed};
  ScriptBuilder script{setting.hand_stiffness};
  script.hold(std::chrono::seconds{1})
      .air(5 * kMillimetre, 1.0, std::chrono::seconds{3})
      .hold(milliseconds{500});
  for (int i = 0; i < kGestures; ++i) {
    script.travel(draws.heads() ? kSiteA : kSiteB);
    kAll[draws.count(0, kAll.size() - 1)](script, draws);
  }
  return script.build();
}

}  // namespace palp::surgeon
