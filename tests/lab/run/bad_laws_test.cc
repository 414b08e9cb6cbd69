#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "judge/metric_table.h"
#include "lab/plan/plan.h"
#include "lab/run/run.h"

/// Goal: the lab is not fooled: what a bad law does is called bad, by the figures that
/// `palp-lab montecarlo` reports of the same cases.
/// Method: laws that nobody should use, in cases of the sets, beside `mmt` in the same case.
namespace palp::lab {
namespace {

using coupling::OutsidePatient;
using coupling::OutsideSurgeon;
using coupling::PatientInput;
using coupling::PatientOutput;
using coupling::SurgeonInput;
using coupling::SurgeonOutput;

class Silent {
 public:
  void begin_epoch(double /*position*/) noexcept {}
};

/// Renders the tissue that `mmt` expects before it felt any, and never listens.
class RendersItsPrior : public Silent {
 public:
  SurgeonOutput step(const SurgeonInput& in, const Lapse& /*lapse*/) noexcept {
    const double stiffness = coupling::ContactEstimatorConfig{}.stiffness_expected;  // [N/m^1.5]
    const bool engaged = in.state == SiteState::Engaged;
    const double force = engaged ? stiffness * std::pow(std::max(0.0, in.position), 1.5) : 0;
    return {force, {in.position, in.velocity, force, std::monostate{}}};
  }
};

/// Never gives a force.
class FeelsNothing : public Silent {
 public:
  SurgeonOutput step(const SurgeonInput& in, const Lapse& /*lapse*/) noexcept {
    return {0, {in.position, in.velocity, 0, std::monostate{}}};
  }
};

/// Goes where `mmt` goes, but retreats from more than a limit of force, and comes again.
class HammersAtTheTip {
 public:
  explicit HammersAtTheTip(double retreat) : law_{coupling::MmtConfig{}}, retreat_{retreat} {}
  void begin_epoch(double position) noexcept { law_.begin_epoch(position); }
  PatientOutput step(const PatientInput& in, const Lapse& lapse) noexcept {
    PatientOutput out = law_.step(in, lapse);
    if (in.contact_force > kLimit && !retreats_) {
      retreats_ = true;
      from_ = in.position;
    }
    if (retreats_ && in.position < from_ - 0.9 * retreat_) retreats_ = false;
    if (retreats_) out.target_position = from_ - retreat_;
    return out;
  }

 private:
  static constexpr double kLimit = 0.3;  ///< [N]

  coupling::MmtPatient law_;
  double retreat_;  ///< [m]
  bool retreats_{};
  double from_{};  ///< [m]
};

using coupling::DirectPatient;
using coupling::MmtConfig;
using coupling::MmtPatient;
using coupling::MmtSurgeon;

template <class Surgeon, class Patient>
coupling::OutsideLaw law(Surgeon surgeon, Patient patient) {
  return {OutsideSurgeon{std::move(surgeon)}, OutsidePatient{std::move(patient)}};
}
coupling::OutsideLaw hammer(double retreat) {
  return law(MmtSurgeon{MmtConfig{}}, HammersAtTheTip{retreat});
}

Scenario case_of(const char* set, std::size_t index) {
  const Plan plan = make_set(set, {.count = index + 1, .seed = 6}).value();
  return make_case(plan, plan.cases[index]).value();
}
/// The tissue of `mmt`'s prior at A, an inclusion at B.
Scenario rehearsed() { return case_of("mc", 0); }
/// A tissue and gestures that nobody chose.
Scenario wild() { return case_of("wild", 12); }

judge::RunMetrics judged(Scenario scenario, const coupling::OutsideLaw& outside) {
  scenario.outside = outside;
  return simulate(scenario).metrics;
}

/// As the report has it: a figure that is undefined is none that is right.
constexpr double kRight = 0.03;  // [-], most that a tap or a hold may be wrong
bool right(const judge::RunMetrics& metrics, std::string_view figure) {
  return std::abs(judge::metric_table()[*judge::metric_index(figure)].value(metrics)) <= kRight;
}
bool all_right(const judge::RunMetrics& metrics) {
  return !metrics.unstable && right(metrics, "known_tap_a_error") &&
         right(metrics, "known_tap_b_error") && right(metrics, "held_a_error") &&
         right(metrics, "held_b_error");
}

TEST(BadLawsTest, AGoodLawIsCalledGoodInTheSameCases) {
  for (const Scenario& scenario : {rehearsed(), wild()}) {
    const judge::RunMetrics metrics =
        judged(scenario, law(MmtSurgeon{MmtConfig{}}, MmtPatient{MmtConfig{}}));
    EXPECT_TRUE(all_right(metrics)) << metrics.unstable_reason;
  }
}

TEST(BadLawsTest, ALawFromOutsideDoesWhatItDoesAsOneOfTheHouse) {
  Scenario scenario = rehearsed();
  scenario.duration = std::chrono::seconds{9};  // some taps
  const std::uint64_t digest = simulate(scenario).digest;
  const PatientDevices devices = patient_devices_of(scenario);
  scenario.outside = law(MmtSurgeon{scenario.coupling.mmt, hand_facts_of(scenario)},
                         MmtPatient{scenario.coupling.mmt, devices});
  EXPECT_EQ(simulate(scenario).digest, digest);
  scenario.outside = law(FeelsNothing{}, MmtPatient{scenario.coupling.mmt, devices});
  EXPECT_NE(simulate(scenario).digest, digest);
}

TEST(BadLawsTest, ALawThatRendersItsPriorAndIgnoresThePeerIsCaughtByAnotherTissue) {
  const coupling::OutsideLaw prior = law(RendersItsPrior{}, DirectPatient{{}});
  const judge::RunMetrics metrics = judged(rehearsed(), prior);
  EXPECT_TRUE(right(metrics, "known_tap_a_error")) << "its prior is this tissue";
  EXPECT_FALSE(right(metrics, "known_tap_b_error"));
  EXPECT_FALSE(right(metrics, "held_b_error"));
  EXPECT_FALSE(right(metrics, "ratio_error"));
  const judge::RunMetrics elsewhere = judged(wild(), prior);
  for (const char* figure :
       {"known_tap_a_error", "known_tap_b_error", "held_a_error", "held_b_error", "ratio_error"}) {
    EXPECT_FALSE(right(elsewhere, figure)) << figure;
  }
}

TEST(BadLawsTest, ALawThatFeelsNothingIsCaughtThoughItIsStable) {
  for (const Scenario& scenario : {rehearsed(), wild()}) {
    const judge::RunMetrics metrics = judged(scenario, law(FeelsNothing{}, DirectPatient{{}}));
    EXPECT_FALSE(metrics.unstable) << metrics.unstable_reason;
    for (const char* figure : {"known_tap_a_error",
                               "known_tap_b_error",
                               "held_a_error",
                               "held_b_error",
                               "ratio_error"}) {
      EXPECT_FALSE(right(metrics, figure)) << figure;
    }
  }
}

TEST(BadLawsTest, ATipThatHammersIsCaughtThoughTheHandFeelsTheTissue) {
  for (const auto& [scenario, retreat] : {std::pair{rehearsed(), 0.5e-3},
                                          std::pair{rehearsed(), 1.5e-3},
                                          std::pair{wild(), 0.8e-3}}) {
    const judge::RunMetrics metrics = judged(scenario, hammer(retreat));
    EXPECT_TRUE(metrics.unstable) << retreat;
    EXPECT_STREQ(metrics.unstable_reason, "the tip swings by itself") << retreat;
    EXPECT_TRUE(right(metrics, "held_a_error")) << "by the hand alone this is a good law";
  }
}

/// Slower than any limit cycle that is looked for: a stage of 10 Hz that goes back by 3 mm.
TEST(BadLawsTest, ATipThatComesAndGoesSlowlyIsCaughtToo) {
  const Scenario scenario = case_of("mc", 3);
  const judge::RunMetrics metrics = judged(scenario, hammer(3e-3));
  EXPECT_TRUE(metrics.unstable);
  EXPECT_STREQ(metrics.unstable_reason, "the tip swings by 1 mm or more under a hand that holds");
  EXPECT_EQ(metrics.contact.tip_swing, 0);
  EXPECT_FALSE(judged(scenario, law(MmtSurgeon{MmtConfig{}}, MmtPatient{MmtConfig{}})).unstable);
}

}  // namespace
}  // namespace palp::lab
