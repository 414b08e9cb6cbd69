#include "lab/plan/locate_session.h"

#include <utility>
#include <vector>

#include "common/core/conventions.h"
#include "common/core/formatted.h"
#include "lab/plan/scenario_file.h"

namespace palp::lab {
namespace {

constexpr double kKilopascal = 1e3;  // [Pa]

}  // namespace

std::string tissue_words(const LocateSession& session,
                         const depth::DepthDatabase::Query* ball,
                         const Place& axis) {
  std::string words = formatted("block e_kpa=%.9g", session.scale * kDatabaseModulus / kKilopascal);
  if (session.spread > 0) {
    words += formatted(" varies=%.9g length=%.9g seed=%llu",
                       session.spread,
                       session.length / kMillimetre,
                       static_cast<unsigned long long>(session.seed >> 12U));
  }
  if (ball == nullptr) return words;
  return words + formatted("; ball depth=%.9g radius=%.9g ratio=%.9g at=%.9g,%.9g",
                           ball->depth / kMillimetre,
                           ball->radius / kMillimetre,
                           ball->ratio,
                           axis.x / kMillimetre,
                           axis.y / kMillimetre);
}

double reach_of(const std::string& script) noexcept { return script == "search" ? 15e-3 : 10e-3; }

Result<Scenario> locate_scenario(const LocateSession& session,
                                 const depth::DepthDatabase::Query* ball,
                                 const Place& axis) {
  auto document = load_scenario("standard");
  if (!document) return tl::unexpected(document.error());
  const std::string delay = formatted("%.9g", 500 * session.round_trip);
  const std::string loss = formatted("%.9g", session.loss);
  for (const auto& [path, value] : std::vector<std::pair<std::string, std::string>>{
           {"surgeon.hand.master", "script:" + session.script},
           {"patient.simulated_phantom.phantom",
            tissue_words(session, ball, {kSiteB.x + axis.x, kSiteB.y + axis.y})},
           {"patient.estimator.youngs_modulus_kpa",
            formatted("%.9g", session.modulus / kKilopascal)},
           {"patient.estimator.place_spread", formatted("%.9g", session.assumed_spread)},
           {"up.delay_ms", delay},
           {"down.delay_ms", delay},
           {"up.loss", loss},
           {"down.loss", loss}}) {
    if (auto done = document->set(path, value, path); !done) return tl::unexpected(done.error());
  }
  auto scenario = make_scenario("locate", *document);
  if (!scenario) return scenario;
  scenario->bare = true;
  scenario->seed = session.seed >> 16U;
  return scenario;
}

}  // namespace palp::lab
