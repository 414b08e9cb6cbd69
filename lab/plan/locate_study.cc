#include "lab/plan/locate_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/random.h"
#include "common/core/small_solver.h"
#include "depth/stroke_tracker.h"
#include "lab/plan/locate_session.h"
#include "lab/run/run.h"
#include "patient_site/phantom.h"
#include "patient_site/simulated_phantom.h"
#include "patient_site/tissue_words.h"

namespace palp::lab {

/// What one phantom is.
struct LocatePhantom {
  depth::DepthDatabase::Query ball;
  Place axis;
  double scale{1};  ///< [-]
};

/// Draws of one case, in a fixed order.
class LocateDraws {
 public:
  LocateDraws(std::uint64_t seed, std::uint32_t index)
      : stream_{seed, 9300 + std::uint64_t{index}} {}
  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  double normal() { return stream_.normal(next_++); }
  std::uint64_t bits() { return stream_.bits(next_++); }

 private:
  RandomStream stream_;
  std::uint64_t next_{};
};

namespace {
constexpr double kStep = 20e-6;            // [m], of a place's table
constexpr double kClearance = 10e-3;       // [m], where a tap begins
constexpr double kSurfaceSpread = 0.2e-3;  // [m], of the surface from place to place
constexpr double kScaleSpread = 0.1;       // [-], of Young's modulus
constexpr double kMargin = 0.15e-3;        // [m], for the servo, before a table's end
constexpr double kRest = 0.2;              // [s], after a tap
constexpr double kRight = 1e-3;            // [m], of place and depth

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
  const double half =
      study.script.empty() ? 0.5 * (study.rows - 1) * study.pitch : reach_of(study.script);
  truth.axis.x = draws.uniform(-half, half);
  truth.axis.y = draws.uniform(-half, half);
  if (study.axis) truth.axis = *study.axis;
  truth.scale = 1 + kScaleSpread * draws.normal();
  return truth;
}

/// What a tip meets at one place.
patient::ForceTable table_at(const depth::DepthDatabase& database,
                             const depth::DepthDatabase::Curve& curve,
                             double scale,
                             const std::function<double(double)>& share) {
  std::vector<patient::ForceRow> rows;
  const depth::DepthDatabase::Curve plain = database.plain();
  const int count = static_cast<int>(curve.indentation_max / kStep + 1e-6);
  for (int i = 0; i <= count; ++i) {
    const double d = i * kStep;
    const double excess = database.log_excess(curve, d) * share(d);
    rows.push_back({d, scale * database.force(plain, d) * std::exp(excess)});
  }
  return *patient::ForceTable::make(std::move(rows));
}

/// Takes every sample of a tap.
using Feel = std::function<void(const ContactSample&)>;

/// One tap, raised cosine, no deeper than `reach_max` [m]; `config` says where, and what is there.
TimePoint tap(const patient::Phantom& phantom,
              patient::SimulatedPhantomConfig config,
              double reach_max,
              LocateDraws& draws,
              TimePoint now,
              const Feel& feel) {
  config.surface_offset = kSurfaceSpread * draws.normal();
  config.start_position = config.surface_offset - kClearance;
  config.seed = draws.bits();
  const double span = draws.uniform(0.7, 1.4);
  const double reach = std::min(draws.uniform(3.6e-3, 4.2e-3), reach_max);
  patient::SimulatedPhantom site{phantom, config};
  const int samples = static_cast<int>((span + kRest) * 1e3);
  for (int i = 0; i < samples; ++i) {
    now += std::chrono::milliseconds{1};
    const patient::StageState stage = site.read(now);
    const auto force = site.sample(now);
    if (force) {
      feel(ContactSample{
          .at = now, .position = stage.position, .force = force->force, .place = stage.place});
    }
    const double t = std::min(i * 1e-3, span) / span;
    const double depth =
        -kClearance + 0.5 * (reach + kClearance) * (1 - std::cos(2 * std::numbers::pi * t));
    site.move_to({config.surface_offset + depth, config.start_place});
  }
  return now + std::chrono::seconds{1};
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
std::vector<depth::PlaceData> LocateBench::touch_all(const TapAt& tap_at) const {
  const depth::StrokeTrackerConfig strokes;
  depth::StrokeTracker tracker{strokes};
  std::vector<depth::PlaceData> places;
  TimePoint now{};
  for (std::uint32_t place = 0; place < study_.rows * study_.rows; ++place) {
    const double middle = 0.5 * (study_.rows - 1);
    const Place at{(place % study_.rows - middle) * study_.pitch,
                   (place / study_.rows - middle) * study_.pitch};
    now = tap_at(at, now, [&](const ContactSample& sample) {
      const auto stroke = tracker.take(sample);
      if (!stroke || stroke->reason != DepthReason::Ok) return;
      auto data = depth::place_data({.place = at,
                                     .touches = stroke->known.touches,
                                     .surface = stroke->known.surface,
                                     .noise = stroke->known.noise,
                                     .quantum = strokes.sensor.step,
                                     .cut_off = strokes.sensor.pole,
                                     .stiffness = {}},
                                    basis_);
      if (data) places.push_back(*data);
    });
  }
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
      return inclusion ? share(truth.ball, offset, std::max(d, kStep)) : 0.0;
    };
    const patient::ForceTable table = table_at(database_, curve, scale, left);
    const patient::Phantom phantom{.name = "place",
                                   .plain = table,
                                   .over = table,
                                   .depth = {},
                                   .radius = {},
                                   .ratio = {},
                                   .shape = "unknown"};
    return tap(phantom, {.start_place = at}, deepest, draws, now, feel);
  });
}

/// In another one.
std::vector<depth::PlaceData> LocateBench::touch_world(const MismatchedWorld& world,
                                                       LocateDraws& draws) const {
  const auto phantom = patient::make_phantom(world.phantom);
  PALP_CHECK(phantom.has_value(), "a world is a sound phantom");
  return touch_all([&](const Place& at, TimePoint now, const Feel& feel) {
    const patient::SimulatedPhantomConfig config{.start_place = at,
                                                 .breathing_amplitude = world.breathing_amplitude,
                                                 .breathing_frequency = world.breathing_frequency,
                                                 .sensor_cut_off = world.sensor_pole};
    return tap(*phantom, config, phantom->depth_max() - kMargin, draws, now, feel);
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
    places = touch_world(world, draws);
  } else {
    out.inclusion = index < study_.count;
    truth = draw(study_, prior_.ball, database_, draws);
    out.scale = truth.scale;
    if (!study_.script.empty()) {
      run_session(truth, draws, out);
      return out;
    }
    places = touch_as_assumed(truth, out.inclusion, draws);
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
                                         .scale = truth.scale,
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
  const depth::MapLikelihood likelihood{
      field_, {.stiffness = {}, .place_spread = study_.assumed_spread}, std::move(places)};
  const depth::MapPosterior posterior = depth::map_posterior(likelihood, field_, prior_);
  const depth::MapVerdict verdict = depth::map_verdict(likelihood, posterior);
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
