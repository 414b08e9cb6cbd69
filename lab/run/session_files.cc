#include "lab/run/session_files.h"

#include <string>

#include "common/config/number.h"
#include "common/link/session.h"
#include "lab/run/session_setup.h"
#include "patient_site/tissue_record.h"
#include "surgeon_site/script_record.h"

namespace palp::lab {
namespace {

/// When runs take place: the first second of the year 2000, in UTC.
constexpr Duration kVirtualEpoch = std::chrono::seconds{946'684'800};

/// What a session's file says of itself: as a site's own does, in virtual time.
record::SessionInfo info_of(const Scenario& scenario, link::Role site, TimePoint now) {
  const bool surgeon = site == link::Role::Surgeon;
  record::SessionInfo info;
  info.site = site;
  info.metadata = {{"program", "palp-lab"},
                   {"protocol_version", std::to_string(link::kProtocolVersion)},
                   {"scenario", scenario.name},
                   {"seed", std::to_string(scenario.seed)},
                   {"time", "virtual"},
                   {"coupling", scenario.coupling.name}};
  info.attachments = {{"config.textproto",
                       "text/plain",
                       surgeon ? scenario.site_texts.surgeon : scenario.site_texts.patient},
                      {"scenario.textproto", "text/plain", scenario.text}};
  info.opened_at = clock_of(scenario, site).local(now);
  info.clock.ahead = kVirtualEpoch - info.opened_at.time_since_epoch();
  info.clock.source = "virtual";
  info.clock.synchronised = "yes";
  return info;
}

}  // namespace

SessionFiles::SessionFiles(const Scenario& scenario, const RunFiles& files, TimePoint start) {
  if (scenario.bare) return;
  record::SessionInfo surgeon = info_of(scenario, link::Role::Surgeon, start);
  surgeon.metadata.emplace_back("surface_offset_mm",
                                config::number_text(scenario.hand.person.surface_offset * 1e3));
  surgeon.metadata.emplace_back("hand", describe(hand_facts_of(scenario)));
  surgeon.metadata.emplace_back(
      "script_round_trip_s",
      config::number_text(seconds(scenario.up.delay.mean + scenario.down.delay.mean)));
  surgeon::describe_script(scenario.script, surgeon);
  surgeon_.emplace(files.surgeon != nullptr ? *files.surgeon : null_surgeon_, surgeon);
  record::SessionInfo patient = info_of(scenario, link::Role::Patient, start);
  const PatientDevices devices = patient_devices_of(scenario);
  patient.metadata.emplace_back("estimator", to_string(scenario.estimator.kind));
  patient.metadata.emplace_back("stage", describe(devices.stage));
  patient.metadata.emplace_back("force_sensor", describe(devices.sensor));
  patient::describe_tissue(
      scenario.phantom, scenario.tissue.surface_offset, scenario.patient.gate, patient);
  patient_.emplace(files.patient != nullptr ? *files.patient : null_patient_, patient);
}

std::uint64_t SessionFiles::records() const {
  return (surgeon_ ? surgeon_->counts().records() : 0) +
         (patient_ ? patient_->counts().records() : 0);
}

void SessionFiles::close() {
  if (surgeon_) surgeon_->close();
  if (patient_) patient_->close();
}

}  // namespace palp::lab
