#pragma once

#include <cstdint>
#include <string>

#include "common/core/result.h"
#include "common/settings/site_settings.h"
#include "depth/depth_estimator.h"
#include "patient_site/patient_node.h"
#include "patient_site/simulated_phantom.h"

namespace palp::config {
class Document;
}  // namespace palp::config
namespace palp::proto::config {
class PatientConfig;
}  // namespace palp::proto::config

namespace palp::patient {

/// All that a patient site is made of, frozen: one struct per part. Without a file or a flag each
/// part has its own defaults.
struct Settings {
  std::string listen;  ///< ADDRESS:PORT; a program needs one, virtual time does not
  settings::ProtectionSettings protection;
  coupling::CouplingConfig coupling;
  std::uint64_t agreement{};  ///< both sites must have the same
  link::LinkConfig link;
  PatientConfig node;
  std::string stage{"sim"};
  std::string force{"sim"};
  std::string devices;  ///< file; empty: none needed
  std::string phantom{"paper-10mm"};
  SimulatedPhantomConfig simulation;
  double tip_radius{5e-3};  ///< [m]
  std::string estimator_kind{"bayes"};
  depth::DepthEstimatorConfig estimator;
  settings::LoopSettings loop;
  settings::ImpairmentSettings impairment;
  settings::RecordSettings record;
  settings::MonitorSettings monitor;
  settings::CameraSettings camera;
  Duration duration{};  ///< 0: until told to stop
  std::uint64_t seed{1};
};

/// The document must have passed its check(). The sentence names what does not exist.
[[nodiscard]] Result<Settings> make_settings(const config::Document& document);
[[nodiscard]] Result<Settings> make_settings(const proto::config::PatientConfig& message);

/// Whether the phantom's forces are those of the site's tip.
[[nodiscard]] Result<void> check_tip(const Settings& settings, const Phantom& phantom);

/// `gate` for a simulated tissue whose surface truly lies at `surface_offset` [m] and whose tables
/// end `depth_max` [m] below it: the tip stops short of what nobody computed.
[[nodiscard]] MotionGateConfig within_tables(MotionGateConfig gate,
                                             double surface_offset,
                                             double depth_max) noexcept;

}  // namespace palp::patient
