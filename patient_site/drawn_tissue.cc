#include "patient_site/drawn_tissue.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/random.h"

namespace palp::patient {
namespace {

constexpr std::uint64_t kTissueDraws = 0x6472'6177'6e74'6973ULL;  // "drawntis"
constexpr double kSecantAt = 3e-3;                                // [m]
constexpr double kDeepest = 10e-3;                                // [m]

/// Successive draws of one tissue.
class TissueDraws {
 public:
  explicit TissueDraws(std::uint64_t seed) : stream_{seed, kTissueDraws} {}
  double between(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  double log_between(double low, double high) {
    return low * std::pow(high / low, stream_.uniform(next_++));
  }
  bool heads() { return stream_.uniform(next_++) < 0.5; }

 private:
  RandomStream stream_;
  std::uint64_t next_{};
};

/// x for x > 0 and 0 below, with a bend as wide as `width` [m] between.
double ramp(double x, double width) { return width * std::log1p(std::exp(x / width)); }

enum class LawKind : std::uint8_t { Power, Exponential, Skin, Kink, Layers };
constexpr std::array kLawKinds{
    LawKind::Power, LawKind::Exponential, LawKind::Skin, LawKind::Kink, LawKind::Layers};

/// A force up to a factor, over the indentation.
struct DrawnLaw {
  LawKind kind{};
  double exponent{};  ///< [-], of Power; of what lies under a skin
  double length{};    ///< [m], over which an exponential grows by e
  double first{};     ///< [m], where a skin ends, where the first layer does
  double second{};    ///< [m], ... the second
  double width{};     ///< [m], of a bend
  double harder{};    ///< [-], what a layer adds to the slope above it
  double skin{};      ///< [-], its slope over the mean slope of what lies under it

  [[nodiscard]] double force(double d) const {
    switch (kind) {
      case LawKind::Power:
        return std::pow(d, exponent);
      case LawKind::Exponential:
        return std::expm1(d / length);
      case LawKind::Skin: {
        const double under = kSecantAt * std::pow(d / kSecantAt, exponent);
        return under + skin * (d - bent(d, first));
      }
      case LawKind::Kink:
        return d + harder * bent(d, first);
      case LawKind::Layers:
        return d + harder * bent(d, first) + 2 * harder * bent(d, second);
    }
    return d;
  }

 private:
  [[nodiscard]] double bent(double d, double where) const {
    return ramp(d - where, width) - ramp(-where, width);
  }
};

DrawnLaw draw_law(LawKind kind, TissueDraws& draws) {
  DrawnLaw law{.kind = kind};
  law.exponent = kind == LawKind::Skin ? draws.between(1, 1.5) : draws.between(0.8, 2.5);
  law.length = draws.between(2e-3, 6e-3);
  law.first = draws.between(1e-3, 3e-3);
  law.second = law.first + draws.between(1e-3, 3e-3);
  law.width = draws.between(0.1e-3, 0.5e-3);
  law.harder = kind == LawKind::Kink ? draws.between(0.5, 3) : draws.between(0.3, 1.5);
  law.skin = draws.between(0.3, 2);
  return law;
}

/// `secant` [N/m], at kSecantAt.
ForceTable table_of(const DrawnLaw& law, double secant) {
  constexpr int kRows = 1500;
  const double scale = secant * kSecantAt / law.force(kSecantAt);
  std::vector<ForceRow> rows;
  for (int i = 0; i <= kRows; ++i) {
    const double indentation = kDeepest * i / kRows;
    rows.push_back({indentation, i == 0 ? 0 : scale * law.force(indentation)});
  }
  Result<ForceTable> table = ForceTable::make(std::move(rows));
  PALP_CHECK(table.has_value(), "every law that is drawn makes a sound table");
  return std::move(*table);
}

}  // namespace

Phantom drawn_tissue(std::uint64_t seed) {
  TissueDraws draws{seed};
  const auto which = static_cast<std::size_t>(draws.between(0, kLawKinds.size()));
  const LawKind kind = kLawKinds[which];
  const double secant = draws.log_between(20, 1500);
  const DrawnLaw at_a = draw_law(kind, draws);
  const DrawnLaw other = draw_law(kind, draws);
  const DrawnLaw at_b = draws.heads() ? other : at_a;
  const double harder = draws.between(1.1, 2.5);
  const double share = draws.between(0.05, 0.35);
  const double time = draws.log_between(0.5, 5);
  return {.name = "random:" + std::to_string(seed),
          .plain = table_of(at_a, secant),
          .over = table_of(at_b, harder * secant),
          .depth = std::nullopt,
          .radius = std::nullopt,
          .ratio = std::nullopt,
          .shape = "unknown",
          .relaxation = draws.heads() ? stretched_relaxation(share, time) : Relaxation{}};
}

}  // namespace palp::patient
