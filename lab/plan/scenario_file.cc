#include "lab/plan/scenario_file.h"

#include <algorithm>

#include "common/config/settings_text.h"
#include "common/core/number_text.h"
#include "common/core/whole_file.h"
#include "lab/plan/scenario_texts.h"
#include "netem/syntax/impairment_text.h"
#include "patient_site/settings.h"
#include "proto/config.pb.h"
#include "surgeon_site/script_source.h"
#include "surgeon_site/settings.h"

namespace palp::lab {
namespace {

using proto::config::LabScenario;

/// The words, if there are any, else the numbers.
Result<netem::Impairment> make_path(const proto::config::Impairment& path) {
  if (!path.spec().empty()) return netem::parse_impairment(path.spec());
  return netem::impairment_from_delay(
      from_seconds(path.delay_ms() * 1e-3), from_seconds(path.jitter_ms() * 1e-3), path.loss());
}

/// Its name is one of the document's, which are all there are.
Fault make_fault(const proto::config::LabFault& message) {
  const auto* const named = std::find(kFaultNames.begin(), kFaultNames.end(), message.kind());
  return {.kind = static_cast<FaultKind>(named - kFaultNames.begin()),
          .at_script_time = from_seconds(message.at_s()),
          .amount = from_seconds(message.amount_s()),
          .count = message.count(),
          .apart = from_seconds(message.apart_s())};
}

DeviceTiming make_timing(const proto::config::LabDevice& message) {
  return {.rate = message.rate_hz(),
          .lag = from_seconds(message.lag_ms() * 1e-3),
          .jitter = from_seconds(message.jitter_ms() * 1e-3)};
}

/// A clock may jump back; a pause, a kill and a failing device last some time.
Result<void> check_fault(const Fault& fault, Duration length) {
  const bool jumps =
      fault.kind == FaultKind::StepSurgeonClock || fault.kind == FaultKind::StepPatientClock;
  if (fault.kind == FaultKind::None) return {};
  if (fault.amount < Duration{0} && !jumps) {
    return fail("fault.amount_s is below 0, which only the jump of a clock may be");
  }
  if (fault.at_script_time >= length) {
    return fail(
        number_text("fault.at_s lies behind the end of the run at ", seconds(length), 3, " s"));
  }
  return {};
}

}  // namespace

Result<config::Document> load_scenario(const std::string& name_or_path) {
  config::Document document = config::scenario_document();
  const auto texts = scenario_texts();
  const auto known = std::find_if(texts.begin(), texts.end(), [&](const ScenarioText& candidate) {
    return candidate.name == name_or_path;
  });
  std::string text;
  if (known != texts.end()) {
    text = known->text;
  } else {
    auto file = read_whole_file(name_or_path);
    if (!file) {
      return fail("'" + name_or_path + "' is neither a scenario of the lab nor a readable file; " +
                  "palp-lab scenarios lists them");
    }
    text = std::move(*file);
  }
  if (auto merged = document.merge(text, name_or_path); !merged) {
    return tl::unexpected(merged.error());
  }
  return document;
}

Result<Scenario> make_scenario(const std::string& name, const config::Document& document) {
  const auto& message = document.as<LabScenario>();
  auto surgeon = surgeon::make_settings(message.surgeon());
  if (!surgeon) return tl::unexpected(surgeon.error());
  auto patient = patient::make_settings(message.patient());
  if (!patient) return tl::unexpected(patient.error());
  if (surgeon->agreement != patient->agreement) {
    return fail("surgeon and patient must have the same coupling settings");
  }
  auto phantom = patient::make_phantom(patient->phantom);
  if (!phantom) return tl::unexpected(phantom.error());
  if (const auto same = patient::check_tip(*patient, *phantom); !same) {
    return tl::unexpected(same.error());
  }
  auto up = make_path(message.up());
  if (!up) return tl::unexpected(up.error());
  auto down = make_path(message.down());
  if (!down) return tl::unexpected(down.error());
  auto script = surgeon::load_script(surgeon->master,
                                     {.hand_stiffness = surgeon->hand.plant.grip.stiffness,
                                      .round_trip = up->delay.mean + down->delay.mean});
  if (!script) return tl::unexpected(script.error());

  patient->node.gate = patient::within_tables(
      patient->node.gate, patient->simulation.surface_offset, phantom->depth_max());
  const Fault fault = make_fault(message.fault());
  const Duration length =
      message.duration_s() > 0 ? from_seconds(message.duration_s()) : script->length();
  if (auto possible = check_fault(fault, length); !possible) {
    return tl::unexpected(possible.error());
  }
  return Scenario{.name = name,
                  .text = document.text(),
                  .site_texts = {.surgeon = config::settings_text(message.surgeon()),
                                 .patient = config::settings_text(message.patient())},
                  .seed = message.seed(),
                  .coupling = surgeon->coupling,
                  .link = surgeon->link,
                  .surgeon = surgeon->node,
                  .hand = surgeon->hand,
                  .script = std::move(*script),
                  .patient = patient->node,
                  .tissue = patient->simulation,
                  .phantom = std::move(*phantom),
                  .timings = {.hand = make_timing(message.hand_device()),
                              .stage = make_timing(message.stage_device()),
                              .sensor = make_timing(message.sensor_device())},
                  .estimator = patient->estimator,
                  .up = std::move(*up),
                  .down = std::move(*down),
                  .duration = from_seconds(message.duration_s()),
                  .bare = false,
                  .fault = fault};
}

std::vector<NamedChoice> described_scenarios() {
  std::vector<NamedChoice> scenarios;
  for (const ScenarioText& known : scenario_texts()) {
    config::Document document = config::scenario_document();
    if (!document.merge(known.text, known.name)) continue;  // tests hold them to be readable
    scenarios.push_back({std::string{known.name}, document.as<LabScenario>().means()});
  }
  return scenarios;
}

}  // namespace palp::lab
