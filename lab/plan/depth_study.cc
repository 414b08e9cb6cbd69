#include "lab/plan/depth_study.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/core/conventions.h"
#include "common/core/random.h"
#include "fem/depth_database.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "patient_site/settings.h"
#include "surgeon_site/script_builder.h"

namespace palp::lab {
namespace {

using std::chrono::milliseconds;

constexpr double kPaperRadius = 15e-3;           // [m]
constexpr double kPaperRatio = 13.1e6 / 15.3e3;  // paper II.B
constexpr double kStage = 5e-3;                  // [m], of lateral: from here site B

/// Draws of one case, each on a stream of its own.
enum class Draw : std::uint64_t { Depth = 9100, Radius, Ratio, Scale, Time, Reach, Grip };

double uniform(const DepthStudy& study, Draw what, std::uint32_t index, double low, double high) {
  return low + (high - low) * random_uniform(study.seed, static_cast<std::uint64_t>(what), index);
}

/// What case `index` of a study is.
struct CasePlan {
  bool inclusion{};
  bool wide{};
  Knowledge knowledge{Knowledge::Range};
  std::uint32_t drawn{};        ///< index of its draws: palpations with the same are the same
  std::optional<double> depth;  ///< [m], of the paper's ball
};

CasePlan plan_of(const DepthStudy& study, std::uint32_t index) {
  if (study.depths.empty()) {
    return {.inclusion = index < study.count || index >= 2 * study.count,
            .wide = index >= 2 * study.count,
            .drawn = index,
            .depth = {}};
  }
  const auto all = static_cast<std::uint32_t>(study.depths.size()) * study.repeats;
  return {.inclusion = true,
          .knowledge = index < all ? Knowledge::Ball : Knowledge::Range,
          .drawn = index % all,
          .depth = study.depths[index % all / study.repeats]};
}

struct Truth {
  fem::DepthDatabase::Query query;
  double scale{1};     ///< [-]
  double tap_time{1};  ///< [s]
  double reach{4e-3};  ///< [m], aimed at
};

/// Depth 4 to 25 mm, radius 3 to 15 mm, ratio 3 to 900, stiffness +-10 %, hands of all speeds.
/// Wide: all that the database has, stiffness +-20 %.
Truth draw(const DepthStudy& study, const CasePlan& plan, const fem::DepthDatabase& database) {
  Truth truth;
  const std::uint32_t index = plan.drawn;
  truth.tap_time = uniform(study, Draw::Time, index, 0.7, 1.4);
  truth.reach = uniform(study, Draw::Reach, index, 3.6e-3, 4.2e-3);
  if (plan.depth) {
    truth.query = {.shape = fem::InclusionShape::Ball,
                   .depth = *plan.depth,
                   .radius = kPaperRadius,
                   .ratio = kPaperRatio};
    return truth;
  }
  const double spread = plan.wide ? 0.2 : 0.1;
  truth.scale = uniform(study, Draw::Scale, index, 1 - spread, 1 + spread);
  const double thin = plan.wide ? 3e-3 : 4e-3;
  const double deep = plan.wide ? 27e-3 : 25e-3;
  // What does not fit into the block is drawn again, on the next index of the same stream.
  for (std::uint32_t attempt = 0; attempt < 50; ++attempt) {
    const std::uint32_t at = index + 1'000'003U * attempt;
    truth.query = {.shape = fem::InclusionShape::Ball,
                   .depth = uniform(study, Draw::Depth, at, thin, deep),
                   .radius = uniform(study, Draw::Radius, at, 3e-3, plan.wide ? 16e-3 : 15e-3),
                   .ratio = 3 * std::pow(300, uniform(study, Draw::Ratio, at, 0, 1))};
    if (database.contains(truth.query)) break;
  }
  return truth;
}

patient::ForceTable table_of(const fem::DepthDatabase& database,
                             const fem::DepthDatabase::Curve& curve,
                             double scale) {
  constexpr double kStep = 20e-6;  // [m]
  std::vector<patient::ForceRow> rows;
  const int count = static_cast<int>(curve.indentation_max / kStep + 1e-6);
  for (int i = 0; i <= count; ++i) {
    rows.push_back({i * kStep, scale * database.force(curve, i * kStep)});
  }
  return *patient::ForceTable::make(std::move(rows));
}

/// Random phantoms are drawn from the prior; of the paper's ball the estimator knows all, or what
/// it assumes unless told.
estimator::DepthPrior prior_of(const CasePlan& plan) {
  if (plan.knowledge == Knowledge::Ball) {
    return {.radius_min = kPaperRadius,
            .radius_max = kPaperRadius,
            .ratio_min = kPaperRatio,
            .ratio_max = kPaperRatio};
  }
  if (plan.depth) return {};
  return {.depth_min = 4e-3,
          .depth_max = 25e-3,
          .radius_min = 3e-3,
          .radius_max = 15e-3,
          .ratio_min = 3,
          .ratio_max = 900};
}

/// What the tip did up to `until`, the reversal with which the last answer came.
std::vector<TipState> motion_of(const RunResult& result, TimePoint until) {
  std::vector<TipState> out;
  for (const RunTick& tick : result.ticks) {
    if (result.began_at + from_seconds(tick.at) > until) break;
    out.push_back({tick.tip, tick.tip_velocity, tick.tip_lateral >= kStage});
  }
  return out;
}

Result<Scenario> scenario_of(const DepthStudy& study,
                             const CasePlan& plan,
                             const Truth& truth,
                             const fem::DepthDatabase& database) {
  auto document = load_scenario("standard");
  if (!document) return tl::unexpected(document.error());
  const double grips = uniform(study, Draw::Grip, plan.drawn, 0, 3);
  const char* grip = grips < 1 ? "light" : grips < 2 ? "mid" : "firm";
  const std::string delay = std::to_string(500 * study.round_trip);
  for (const auto& [path, value] : std::vector<std::pair<std::string, std::string>>{
           {"surgeon.hand.grip", grip},
           {"up.delay_ms", delay},
           {"down.delay_ms", delay},
           {"up.loss", std::to_string(study.loss)},
           {"down.loss", std::to_string(study.loss)},
           {"surgeon.coupling.name", study.coupling},
           {"patient.coupling.name", study.coupling}}) {
    if (value.empty()) continue;
    if (auto done = document->set(path, value, path); !done) return tl::unexpected(done.error());
  }
  auto scenario = make_scenario("standard", *document);
  if (!scenario) return scenario;
  scenario->bare = true;
  scenario->seed = random_bits(study.seed, 9000, plan.drawn) >> 16;
  scenario->phantom.name = "database";
  scenario->phantom.plain = table_of(database, database.plain(), truth.scale);
  scenario->phantom.over = plan.inclusion
                               ? table_of(database, database.curve(truth.query), truth.scale)
                               : scenario->phantom.plain;
  scenario->patient.gate =
      patient::within_tables(scenario->patient.gate, 0, scenario->phantom.depth_max());
  surgeon::ScriptBuilder script{scenario->hand.plant.grip.stiffness};
  const auto span = from_seconds(truth.tap_time);
  script.hold(milliseconds{500}).move(-3e-3, milliseconds{700});
  if (study.reference_taps > 0) {
    script.taps(
        static_cast<std::uint32_t>(study.reference_taps), truth.reach, span, milliseconds{300});
  }
  script.site(surgeon::kSiteB)
      .taps(static_cast<std::uint32_t>(study.taps), truth.reach, span, milliseconds{300})
      .hold(milliseconds{300});
  scenario->script = script.build();
  scenario->duration = {};
  scenario->estimator.kind = study.estimator;
  scenario->estimator.bayes.prior = prior_of(plan);
  return scenario;
}

}  // namespace

std::uint32_t case_count(const DepthStudy& study) {
  if (study.depths.empty()) return 2 * study.count + study.wide_count;
  // The paper's estimator knows nothing beforehand.
  const std::uint32_t kinds = study.estimator == estimator::EstimatorKind::Bayes ? 2 : 1;
  return static_cast<std::uint32_t>(study.depths.size()) * study.repeats * kinds;
}

Result<DepthCase> run_case(const DepthStudy& study, std::uint32_t index) {
  const auto database = fem::default_database();
  if (!database) return tl::unexpected(database.error());
  const CasePlan plan = plan_of(study, index);
  const Truth truth = draw(study, plan, *database);
  const auto scenario = scenario_of(study, plan, truth, *database);
  if (!scenario) return tl::unexpected(scenario.error());
  const RunResult result = simulate(*scenario);
  DepthCase out;
  out.index = index;
  out.inclusion = plan.inclusion;
  out.wide = plan.wide;
  out.knowledge = plan.knowledge;
  out.scale = truth.scale;
  out.assumed_low = prior_of(plan).depth_min;
  out.assumed_high = prior_of(plan).depth_max;
  TimePoint answered = TimePoint::max();
  for (const DepthEstimate& estimate : result.depths) {
    if (estimate.lateral < kStage) continue;
    ++out.strokes;
    if (estimate.verdict == DepthVerdict::Invalid) continue;
    out.verdict = estimate.verdict;  // the last one has heard all taps
    answered = estimate.stroke_ended_at;
    out.estimate = estimate.depth;
    out.low = estimate.depth_low;
    out.high = estimate.depth_high;
    out.stddev = estimate.depth_stddev;
    out.excluded = estimate.verdict == DepthVerdict::None ? estimate.depth_low : 0;
    out.hash = estimate.hash;
    out.indentation = std::max(out.indentation, estimate.indentation_max);
  }
  if (!plan.inclusion) return out;
  out.depth = truth.query.depth;
  out.radius = truth.query.radius;
  out.ratio = truth.query.ratio;
  const estimator::StiffnessPrior stiffness{.scale = truth.scale};
  const DepthBound bound = depth_bound(
      *database, truth.query, prior_of(plan), stiffness, {}, motion_of(result, answered));
  out.bound = bound.depth_stddev;
  out.signal = bound.signal;
  return out;
}

}  // namespace palp::lab
