#include "study/known_truth.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace palp::study {
namespace {

constexpr double kBias = 0.03;         // [-]
constexpr double kOverBound = 1.15;    // [-]
constexpr double kBoundOfOne = 1.385;  // [-], of ln JND from one answer, lapses 2 %
constexpr std::size_t kTrials = 60;    // of each observer; yes or no: of each kind

Target held(const std::string& of, double share) { return {of + ": intervals", share, 0.93, 0.97}; }

}  // namespace

std::vector<Target> known_truth(std::size_t observers,
                                std::uint64_t seed,
                                const ForEachIndex& for_each_index) {
  std::vector<Target> out;
  for (const MethodKind kind :
       {MethodKind::QuestPlus, MethodKind::Quest, MethodKind::Staircase, MethodKind::Constant}) {
    RecoverySet set{.method = {.kind = kind}, .seed = seed};
    // A staircase ends by its reversals.
    if (kind == MethodKind::Staircase) set.method.stop.trials_max = 10 * kTrials;
    const RecoverySummary found = summary_of(set, recover(set, observers, for_each_index));
    const std::string name{to_string(kind)};
    if (kind == MethodKind::QuestPlus) {
      out.push_back({name + ": bias of ln JND", found.bias, -kBias, kBias});
      out.push_back({name + ": sd of ln JND",
                     found.sd,
                     0,
                     kOverBound * kBoundOfOne / std::sqrt(double{kTrials})});
    }
    out.push_back(held(name, found.held));
  }
  for (const double d_prime : kKnownSensitivities) {
    const YesNoSummary found =
        recover_yes_no(d_prime, kKnownCriterion, kTrials, 10 * observers, seed);
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "yes-no, d' %.1f", d_prime);
    const std::string of{name.data()};
    out.push_back({of + ": bias of d'", found.d_prime_bias, -kBias, kBias});
    out.push_back(held(of + ", d'", found.d_prime_held));
    out.push_back({of + ": bias of criterion", found.criterion_bias, -kBias, kBias});
    out.push_back(held(of + ", criterion", found.criterion_held));
  }
  return out;
}

std::string targets_text(std::span<const Target> targets) {
  std::string text;
  for (const Target& one : targets) {
    std::array<char, 160> line{};
    std::snprintf(line.data(),
                  line.size(),
                  "%-36s %+.3f  from %+.3f to %.3f  %s\n",
                  one.what.c_str(),
                  one.found,
                  one.low,
                  one.high,
                  one.holds() ? "holds" : "MISSED");
    text += line.data();
  }
  return text;
}

}  // namespace palp::study
