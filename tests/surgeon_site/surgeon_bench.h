#pragma once

#include <functional>
#include <memory>

#include "surgeon_site/surgeon_node.h"
#include "tests/surgeon_site/two_ends.h"

namespace palp::surgeon {

/// A device that a test holds in its hand.
class HeldDevice final : public HapticDevice {
 public:
  HandState read(TimePoint now) noexcept override {
    state.sampled_at = now;
    return state;
  }
  void apply(double force) noexcept override { force_applied = force; }
  void show(const OperatorView& view) noexcept override { shown = view; }
  [[nodiscard]] HandFacts hand_facts() const noexcept override { return {}; }

  HandState state;
  OperatorView shown;
  double force_applied{};  ///< [N]
};

/// Both sites on one wire, a millisecond at a time.
class Bench {
 public:
  explicit Bench(HapticDevice& device, SurgeonConfig config = {})
      : device_{device}, node_{config, {device, law_, link_, recorder}} {
    open_session(link_, up, down, 1, now);
  }

  void run(
      Duration span, const std::function<bool()>& busy = [] { return true; }) {
    for (const TimePoint end = now + span; now < end && busy();) {
      now += std::chrono::milliseconds{1};
      node_.tick(now);
      if (patient_lives) patient.tick(now);
    }
  }
  [[nodiscard]] SurgeonStatus status() { return node_.status().get(); }
  void restart_patient(std::uint64_t session_id) {
    open_session(link_, up, down, session_id, now);
    patient.restart(session_id, now);
    patient_lives = true;
  }
  [[nodiscard]] SurgeonNode& node() { return node_; }

  TimePoint now{};
  Wire up;
  Wire down;
  PlainPatient patient{down, up};
  bool patient_lives{true};
  Keeper recorder;

 private:
  HapticDevice& device_;
  coupling::SurgeonCoupling law_{coupling::DirectSurgeon{{}}};
  link::Link link_{link::LinkConfig{}, std::make_unique<link::RawCodec>()};
  SurgeonNode node_;
};

}  // namespace palp::surgeon
