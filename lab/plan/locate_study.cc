#include "lab/plan/locate_study.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/random.h"
#include "common/core/small_solver.h"
#include "lab/plan/locate_taps.h"
#include "lab/run/run.h"
#include "patient_site/phantom.h"
#include "patient_site/simulated_phantom.h"
#include "patient_site/tissue_words.h"
#include "surgeon_site/script_builder.h"

namespace palp::lab {

namespace {
constexpr double kScaleSpread = 0.1;  // [-], of Young's modulus
constexpr double kMargin = 0.15e-3;   // [m], for the servo, before a table's end
constexpr double kRight = 1e-3;       // [m], of place and depth

/// From what the estimator assumes; the axis anywhere between the outer places.
LocatePhantom draw(const LocateStudy& study,
                   const depth::DepthPrior& prior,
                   const depth::DepthDatabase& database,
                   LocateDraws& draws) {
  LocatePhantom truth;
  do {
    if (study.ball) {
      truth.ball = *study.ball;
      break;
    }
    truth.ball = {.shape = prior.shape,
                  .depth = draws.uniform(prior.depth_min, study.depth_max),
                  .radius = draws.uniform(prior.radius_min, prior.radius_max),
                  .ratio = prior.ratio_min *
                           std::pow(prior.ratio_max / prior.ratio_min, draws.uniform(0, 1))};
  } while (!database.contains(truth.ball));
  const double half = study.rule             ? reach_of("search")
                      : study.script.empty() ? 0.5 * (study.rows - 1) * study.pitch
                                             : reach_of(study.script);
  truth.axis.x = draws.uniform(-half, half);
  truth.axis.y = draws.uniform(-half, half);
  if (study.axis) truth.axis = *study.axis;
  truth.scale = study.modulus / kDatabaseModulus * (1 + kScaleSpread * draws.normal());
  return truth;
}

/// What the estimator knows of the tissue beforehand.
depth::StiffnessPrior stiffness_of(const LocateStudy& study) {
  return {.scale = study.told / kDatabaseModulus};
}

/// The bound of each coordinate: what the touches tell at the truth, and the prior as a normal
/// distribution of the same variance.
std::array<double, kLocated> bounds_at(const depth::MapLikelihood& likelihood,
                                       const depth::MapPrior& prior,
                                       const depth::MapBall& truth) {
  const auto local = likelihood.around(truth);
  const depth::DepthPrior& ball = prior.ball;
  const auto even = [](double low, double high) {
    return 12 / std::max((high - low) * (high - low), 1e-24);
  };
  const double depth = std::exp(truth.log_depth);
  const std::array<double, kLocated> known{
      1 / (prior.reach * prior.reach),
      1 / (prior.reach * prior.reach),
      even(ball.depth_min, ball.depth_max) * depth * depth,
      even(ball.radius_min, ball.radius_max),
      even(std::log(ball.ratio_min), std::log(ball.ratio_max))};
  std::array<double, kLocated> out{};
  for (std::size_t k = 0; k < kLocated; ++k) {
    SmallSystem<kLocated> system;
    system.matrix = local.information;
    for (std::size_t i = 0; i < kLocated; ++i) system.matrix[i][i] += known[i];
    system.right[k] = 1;
    out[k] = std::sqrt(std::max(0.0, solve(system).x[k]));
  }
  out[2] *= depth;
  return out;
}

/// Medians and intervals.
void tell(const depth::MapPosterior& posterior, std::array<Located, kLocated>& out) {
  const std::array<const depth::Estimated*, kLocated> told{
      &posterior.x, &posterior.y, &posterior.depth, &posterior.radius, &posterior.ratio};
  for (std::size_t i = 0; i < kLocated; ++i) {
    Located& one = out[i];
    one.median = told[i]->median;
    one.low = told[i]->low;
    one.high = told[i]->high;
  }
  Located& ratio = out.back();
  for (double* value : {&ratio.median, &ratio.low, &ratio.high}) *value = std::log(*value);
}

}  // namespace

Result<void> take_ball(const std::string& words, LocateStudy& study) {
  const auto described = patient::parse_tissue_words("ball " + words);
  if (!described) return fail("--ball", described.error());
  const patient::PlacedInclusion& one = described->block.inclusions.front();
  study.ball = one.body;
  if (words.find("at=") != std::string::npos) study.axis = one.axis;
  return {};
}

Result<LocateBench> LocateBench::make(const LocateStudy& study) {
  auto database = depth::default_database();
  if (!database) return tl::unexpected(database.error());
  return LocateBench{study, std::move(*database)};
}

LocateBench::LocateBench(const LocateStudy& study, depth::DepthDatabase database)
    : study_{study},
      database_{std::move(database)},
      prior_{.ball = {.depth_max = study.depth_max}, .block_height = database_.grid().block.height},
      field_{database_, prior_.ball, depth::lateral_share(database_)},
      basis_{database_} {}

/// One tap at every place of the pattern.
std::vector<depth::PlaceData> LocateBench::touch_all(const Palpation::TapAt& tap_at) const {
  Palpation hand{basis_, stiffness_of(study_), tap_at};
  std::vector<depth::PlaceData> places;
  for (std::uint32_t place = 0; place < study_.rows * study_.rows; ++place) {
    const double middle = 0.5 * (study_.rows - 1);
    const std::uint32_t row = place / study_.rows;
    const std::uint32_t column = place % study_.rows;
    const auto felt = hand.touch({(column - middle) * study_.pitch, (row - middle) * study_.pitch});
    if (felt) places.push_back(*felt);
  }
  return places;
}

std::string LocateBench::words_of(const LocatePhantom& truth,
                                  bool inclusion,
                                  LocateDraws& draws) const {
  return tissue_words({.spread = study_.spread,
                       .length = study_.length,
                       .scale = truth.scale,
                       .seed = draws.bits()},
                      inclusion ? &truth.ball : nullptr,
                      truth.axis);
}

/// Tap by tap, in tissue that varies as that of a session.
std::vector<depth::PlaceData> LocateBench::touch_by_rule(const LocatePhantom& truth,
                                                         LocateDraws& draws,
                                                         LocateCase& out) const {
  const auto phantom = patient::make_phantom(words_of(truth, out.inclusion, draws));
  PALP_CHECK(phantom.has_value(), "a study's phantoms are sound");
  const depth::StiffnessPrior stiffness = stiffness_of(study_);
  Palpation hand{basis_, stiffness, [&](const Place& at, TimePoint now, const Feel& feel) {
                   const double deepest = phantom->depth_max() - kMargin;
                   const TapMotion search{.clearance = -surgeon::kNearPlace,
                                          .span = seconds(surgeon::kSearchSpan),
                                          .reach = surgeon::kSearchDepth};
                   return tap(*phantom, {.start_place = at}, deepest, search, draws, now, feel);
                 }};
  std::vector<depth::PlaceData> places;
  out.searched =
      search_field(*study_.rule,
                   {.field = field_,
                    .prior = prior_,
                    .tissue = {.stiffness = stiffness, .place_spread = study_.assumed_spread},
                    .config = {.travel = kFieldHalf, .verdict = {}}},
                   hand,
                   out.inclusion ? std::optional{truth.axis} : std::nullopt,
                   places);
  return places;
}

/// In tissue as the estimator assumes it.
std::vector<depth::PlaceData> LocateBench::touch_as_assumed(const LocatePhantom& truth,
                                                            bool inclusion,
                                                            LocateDraws& draws) const {
  const depth::DepthDatabase::Curve plain = database_.plain();
  const depth::DepthDatabase::Curve curve = inclusion ? database_.curve(truth.ball) : plain;
  // As a site's gate: what was not computed is not touched.
  const double deepest = curve.indentation_max - kMargin;
  const depth::LateralShare share = depth::lateral_share(database_);
  return touch_all([&](const Place& at, TimePoint now, const Feel& feel) {
    const double scale = truth.scale * std::exp(study_.spread * draws.normal());
    const double offset = distance(at, truth.axis);
    const auto left = [&](double d) {
      return inclusion ? share(truth.ball, offset, std::max(d, 1e-6)) : 0.0;
    };
    const patient::ForceTable table = table_at(database_, curve, scale, left);
    const patient::Phantom phantom{.name = "place",
                                   .plain = table,
                                   .over = table,
                                   .depth = {},
                                   .radius = {},
                                   .ratio = {},
                                   .shape = "unknown"};
    return tap(phantom, {.start_place = at}, deepest, std::nullopt, draws, now, feel);
  });
}

/// In one that make_phantom() reads.
std::vector<depth::PlaceData> LocateBench::touch_tissue(
    const std::string& words,
    const patient::SimulatedPhantomConfig& config,
    LocateDraws& draws) const {
  const auto phantom = patient::make_phantom(words);
  PALP_CHECK(phantom.has_value(), "a study's phantoms are sound");
  return touch_all([&](const Place& at, TimePoint now, const Feel& feel) {
    patient::SimulatedPhantomConfig here = config;
    here.start_place = at;
    return tap(*phantom, here, phantom->depth_max() - kMargin, std::nullopt, draws, now, feel);
  });
}

LocateCase LocateBench::run(std::uint32_t index) const {
  LocateDraws draws{study_.seed, index};
  LocateCase out;
  out.index = index;
  LocatePhantom truth;
  std::vector<depth::PlaceData> places;
  if (study_.mismatch) {
    const double half = 0.5 * (study_.rows - 1) * study_.pitch;
    const MismatchedWorld world = mismatched_world(study_.seed, index, half);
    out.kind = world.kind;
    out.inclusion = world.inclusion;
    truth = {.ball = {.depth = world.depth, .radius = world.radius, .ratio = world.ratio},
             .axis = world.axis};
    places = touch_tissue(world.phantom,
                          {.breathing_amplitude = world.breathing_amplitude,
                           .breathing_frequency = world.breathing_frequency,
                           .sensor_cut_off = world.sensor_pole},
                          draws);
  } else {
    out.inclusion = index < study_.count;
    truth = draw(study_, prior_.ball, database_, draws);
    out.scale = truth.scale;
    if (!study_.script.empty()) {
      run_session(truth, draws, out);
      return out;
    }
    if (study_.rule) {
      places = touch_by_rule(truth, draws, out);
    } else if (study_.spread > 0 && study_.length > 0) {
      places = touch_tissue(words_of(truth, out.inclusion, draws), {}, draws);
    } else {
      places = touch_as_assumed(truth, out.inclusion, draws);
    }
  }
  out.scale = truth.scale;
  if (places.empty()) return out;
  judge(truth, std::move(places), out);
  return out;
}

/// With a hand, over a link.
void LocateBench::run_session(const LocatePhantom& truth,
                              LocateDraws& draws,
                              LocateCase& out) const {
  const auto scenario = locate_scenario({.script = study_.script,
                                         .round_trip = study_.round_trip,
                                         .loss = study_.loss,
                                         .assumed_spread = study_.assumed_spread,
                                         .spread = study_.spread,
                                         .length = study_.length,
                                         .scale = truth.scale,
                                         .modulus = study_.told,
                                         .seed = draws.bits()},
                                        out.inclusion ? &truth.ball : nullptr,
                                        truth.axis);
  PALP_CHECK(scenario.has_value(), "a study's sessions are sound");
  const RunResult result = simulate(*scenario);
  const MapReport& map = result.map;
  out.found = map.verdict == DepthVerdict::Found;
  out.doubts = map.doubts;
  out.log_evidence = map.log_odds;
  out.strokes = static_cast<std::uint32_t>(result.depths.size());
  const std::array<const palp::Located*, 4> told{&map.x, &map.y, &map.depth, &map.radius};
  const std::array<double, 4> is{truth.axis.x, truth.axis.y, truth.ball.depth, truth.ball.radius};
  const std::array<double, 4> from{kSiteB.x, kSiteB.y, 0, 0};
  for (std::size_t i = 0; i < told.size(); ++i) {
    Located& one = out.coordinates[i];
    one.median = told[i]->median - from[i];
    one.low = told[i]->low - from[i];
    one.high = told[i]->high - from[i];
    if (out.inclusion) one.truth = is[i];
  }
  if (out.inclusion) out.ratio = truth.ball.ratio;
}

/// What is said of the touches, beside the truth.
void LocateBench::judge(const LocatePhantom& truth,
                        std::vector<depth::PlaceData> places,
                        LocateCase& out) const {
  const double begin = study_.clock ? study_.clock() : 0;
  const depth::MapLikelihood likelihood{
      field_,
      {.stiffness = stiffness_of(study_), .place_spread = study_.assumed_spread},
      std::move(places)};
  const depth::MapPosterior posterior = depth::map_posterior(likelihood, field_, prior_);
  const depth::MapVerdict verdict = depth::map_verdict(likelihood, posterior);
  if (study_.clock) out.update = study_.clock() - begin;
  out.found = verdict.found;
  for (const MapDoubt doubt : verdict.doubts) out.doubts |= doubts_of(doubt);
  out.log_evidence = posterior.log_evidence;
  out.balls_worth = posterior.balls_worth;
  out.worst_curve = verdict.worst_curve;
  out.worst_deviation = verdict.worst_deviation;
  tell(posterior, out.coordinates);
  if (!out.inclusion) return;
  out.ratio = truth.ball.ratio;
  const std::array<double, kLocated> is{
      truth.axis.x, truth.axis.y, truth.ball.depth, truth.ball.radius, std::log(truth.ball.ratio)};
  const auto bounds = bounds_at(likelihood, prior_, {truth.axis, std::log(is[2]), is[3], is[4]});
  for (std::size_t i = 0; i < kLocated; ++i) {
    out.coordinates[i].truth = is[i];
    out.coordinates[i].bound = bounds[i];
  }
}

bool LocateCase::confidently_wrong() const {
  if (!found || doubts != 0) return false;
  if (!inclusion) return true;
  for (std::size_t i = 0; i + 1 < kLocated; ++i) {
    const Located& one = coordinates[i];
    if (one.truth < one.low || one.truth > one.high) return true;
  }
  return false;
}

bool LocateCase::right() const {
  if (!inclusion || !found || doubts != 0) return false;
  const auto off = [&](std::size_t i) {
    return std::abs(coordinates[i].median - coordinates[i].truth);
  };
  const Located& radius = coordinates[3];
  const bool size = radius.low <= radius.truth && radius.truth <= radius.high;
  return off(0) <= kRight && off(1) <= kRight && off(2) <= kRight && size;
}

std::uint32_t case_count(const LocateStudy& study) {
  return study.mismatch ? study.count : 2 * study.count;
}

}  // namespace palp::lab
