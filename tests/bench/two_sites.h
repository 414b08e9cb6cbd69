#pragma once

#include <memory>
#include <string>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/link/codec_wire.h"
#include "common/record/queue_recorder.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/session_setup.h"
#include "netem/model/pipe.h"
#include "netem/syntax/impairment_text.h"
#include "patient_site/patient_node.h"
#include "surgeon_site/surgeon_node.h"

namespace palp::bench {

/// The scenario `standard` with a coupling of that name, on a path of 20 ms with jitter and loss.
inline lab::Scenario standard_scenario(const std::string& coupling) {
  lab::Scenario scenario =
      lab::make_scenario("standard", lab::load_scenario("standard").value()).value();
  scenario.coupling.name = coupling;
  scenario.up = netem::parse_impairment("delay 10ms 1ms distribution normal loss 1%").value();
  scenario.down = scenario.up;
  return scenario;
}

/// The queue of a site, or nothing.
class SwitchedRecorder final : public record::Recorder {
 public:
  explicit SwitchedRecorder(record::QueueRecorder& queue) : queue_{queue} {}
  bool record(const Record& record) noexcept override { return !on || queue_.record(record); }
  bool on{true};

 private:
  record::QueueRecorder& queue_;
};

/// Both nodes with real telegrams, records and simulated devices; the script palpates. Contact
/// samples and records wait until somebody takes them.
class TwoSites {
 public:
  static constexpr std::size_t kQueue = 8192;

  TwoSites(const lab::Scenario& scenario, TimePoint now)
      : scenario_{scenario},
        pipe_{scenario.up, scenario.down, 1, kQueue, now},
        surgeon_link_{scenario.link, std::make_unique<link::WireCodec>()},
        patient_link_{scenario.link, std::make_unique<link::WireCodec>()},
        surgeon_setup_{scenario_, link::Role::Surgeon, pipe_.surgeon_end()},
        patient_setup_{scenario_, link::Role::Patient, pipe_.patient_end()},
        hand_{scenario_.hand, scenario_.script},
        surgeon_law_{coupling::make_surgeon_coupling(scenario.coupling).value()},
        surgeon_{scenario_.surgeon, {hand_, surgeon_law_, surgeon_link_, surgeon_switch_}},
        tissue_{scenario_.phantom, scenario_.tissue},
        patient_law_{coupling::make_patient_coupling(scenario.coupling).value()},
        patient_{scenario_.patient,
                 {tissue_,
                  tissue_,
                  patient_law_,
                  patient_link_,
                  patient_switch_,
                  contact_,
                  found_,
                  cells_}} {
    surgeon_setup_.start(surgeon_link_, now);
    patient_setup_.start(patient_link_, now);
  }

  void tick_surgeon(TimePoint now) { surgeon_.tick(now); }
  void tick_patient(TimePoint now) { patient_.tick(now); }
  /// From now on records are kept, as they are first, or not.
  void record(bool on) { surgeon_switch_.on = patient_switch_.on = on; }
  /// Thread: that of the ticks.
  void drop_records() {
    surgeon_records_.drain([](const Record&) {});
    patient_records_.drain([](const Record&) {});
  }
  [[nodiscard]] SpscQueue<ContactSample>& contact() { return contact_; }
  [[nodiscard]] Mailbox<Findings>& found() { return found_; }
  [[nodiscard]] Mailbox<MapCells>& cells() { return cells_; }
  /// Thread: who else would read contact().
  void drop_contact() {
    ContactSample sample;
    while (contact_.try_dequeue(sample)) continue;
  }

 private:
  lab::Scenario scenario_;
  netem::Pipe pipe_;
  link::Link surgeon_link_;
  link::Link patient_link_;
  lab::SessionSetup surgeon_setup_;
  lab::SessionSetup patient_setup_;
  record::QueueRecorder surgeon_records_{kQueue};
  record::QueueRecorder patient_records_{kQueue};
  SwitchedRecorder surgeon_switch_{surgeon_records_};
  SwitchedRecorder patient_switch_{patient_records_};
  surgeon::SimulatedHand hand_;
  coupling::SurgeonCoupling surgeon_law_;
  surgeon::SurgeonNode surgeon_;
  patient::SimulatedPhantom tissue_;
  coupling::PatientCoupling patient_law_;
  SpscQueue<ContactSample> contact_{kQueue};
  Mailbox<Findings> found_;
  Mailbox<MapCells> cells_;
  patient::PatientNode patient_;
};

}  // namespace palp::bench
