#include "lab/site_process.h"

#include <array>
#include <utility>

#include "common/core/random.h"
#include "common/link/codec_protobuf.h"
#include "common/link/packet_protection.h"
#include "lab/adversary.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kEntropyStream = 0x656e'7472'6f70'0000ULL;  ///< "entrop": ids of sessions

/// Where clocks step there are two of them, both long since started: none may fall below 0.
constexpr Duration kSurgeonAhead = std::chrono::hours{1};
constexpr Duration kPatientAhead = std::chrono::hours{7};

std::unique_ptr<link::Codec> make_codec(const Scenario& scenario) {
  if (scenario.bare) return std::make_unique<link::RawCodec>();
  return std::make_unique<link::ProtobufCodec>();
}

std::unique_ptr<link::Codec> patient_codec(const Scenario& scenario) {
  auto codec = make_codec(scenario);
  if (!scenario.lying) return codec;
  return std::make_unique<LyingCodec>(std::move(codec), scenario.seed, scenario.link.period);
}

/// A session as the handshake would have left it.
link::Handover handover(std::unique_ptr<link::Transport> transport) {
  return {.transport = std::move(transport),
          .protection = std::make_unique<link::PlainProtection>(),
          .send_connection = 1,
          .receive_connection = 1,
          .session_id = 1};
}

/// Another 64 bits for every start of a process.
std::uint64_t entropy(const Scenario& scenario, link::Role role, std::uint64_t start) {
  return random_bits(scenario.seed, kEntropyStream + static_cast<std::uint64_t>(role), start);
}

link::SessionConfig session_config(const Scenario& scenario, link::Role role) {
  return {.role = role, .coupling = scenario.coupling.name, .git = {}};
}

bool by_handshake(const Scenario& scenario) { return scenario.fault.kind != FaultKind::None; }

/// A dead process reads nothing: its socket is gone and so is what comes meanwhile.
void drop_all(link::Transport& end, TimePoint now) {
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  while (end.receive(buffer, now)) continue;
}

}  // namespace

surgeon::HandState HandAtClock::read(TimePoint now) noexcept {
  surgeon::HandState state = hand_.read(clock_.world(now));
  state.sampled_at = clock_.local(state.sampled_at);
  if (lifted_) state.dead_man_held = false;
  held_ = state.dead_man_held;
  return state;
}

patient::StageState PhantomAtClock::read(TimePoint now) noexcept {
  patient::StageState state = phantom_.read(clock_.world(now));
  state.sampled_at = clock_.local(state.sampled_at);
  return state;
}

std::optional<patient::ForceSample> PhantomAtClock::sample(TimePoint now) noexcept {
  auto sample = phantom_.sample(clock_.world(now));
  if (sample) sample->sampled_at = clock_.local(sample->sampled_at);
  return sample;
}

SurgeonProcess::Running::Running(SurgeonProcess& owner)
    : link{owner.scenario_.link, make_codec(owner.scenario_)},
      law{coupling::make_surgeon_coupling(owner.scenario_.coupling).value()},
      node{owner.scenario_.surgeon, {owner.device_, law, link, owner.recorder_}} {}

SurgeonProcess::SurgeonProcess(const Scenario& scenario,
                               surgeon::SimulatedHand& hand,
                               std::unique_ptr<link::Transport> end,
                               record::Recorder& recorder)
    : scenario_{scenario},
      hand_{hand},
      clock_{by_handshake(scenario) ? kSurgeonAhead : Duration{0}},
      device_{hand, clock_},
      end_{std::move(end)},
      recorder_{recorder} {}

void SurgeonProcess::start(TimePoint now) {
  parts_.emplace(*this);
  const std::uint64_t random = entropy(scenario_, link::Role::Surgeon, starts_++);
  if (by_handshake(scenario_)) {
    parts_->conversation.emplace(
        session_config(scenario_, link::Role::Surgeon), random, *end_, clock_, parts_->link);
  } else {
    (void)parts_->link.adopt(handover(std::move(end_)), now);
  }
}

void SurgeonProcess::kill(TimePoint now) {
  parts_.reset();
  drop_all(*end_, now);
  const double offset = status_.offset;
  const double lateral = status_.lateral;
  status_ = {};
  status_.offset = offset;
  status_.lateral = lateral;
}

void SurgeonProcess::tick(TimePoint now) {
  if (!parts_) {
    // A device that nobody writes to any more lets go by itself.
    (void)hand_.read(now);
    hand_.apply(0);
    hand_.show({});
    drop_all(*end_, now);
    return;
  }
  parts_->node.tick(clock_.local(now));
  if (parts_->conversation) parts_->conversation->step(now);
  status_ = parts_->node.status().get();
}

link::LinkHealth SurgeonProcess::health(TimePoint now) const noexcept {
  return parts_ ? parts_->link.health(clock_.local(now)) : link::LinkHealth{};
}

PatientProcess::Running::Running(PatientProcess& owner)
    : link{owner.scenario_.link, patient_codec(owner.scenario_)},
      law{coupling::make_patient_coupling(owner.scenario_.coupling).value()},
      node{owner.scenario_.patient,
           {owner.device_,
            owner.device_,
            law,
            link,
            owner.around_.recorder,
            owner.around_.contact,
            owner.around_.depth}} {}

PatientProcess::PatientProcess(const Scenario& scenario,
                               const Surroundings& around,
                               std::unique_ptr<link::Transport> end)
    : scenario_{scenario},
      around_{around},
      clock_{by_handshake(scenario) ? kPatientAhead : Duration{0}},
      device_{around.phantom, clock_},
      end_{std::move(end)} {}

void PatientProcess::start(TimePoint now) {
  parts_.emplace(*this);
  const std::uint64_t random = entropy(scenario_, link::Role::Patient, starts_++);
  if (by_handshake(scenario_)) {
    parts_->conversation.emplace(
        session_config(scenario_, link::Role::Patient), random, *end_, clock_, parts_->link);
  } else {
    (void)parts_->link.adopt(handover(std::move(end_)), now);
  }
}

void PatientProcess::kill(TimePoint now) {
  parts_.reset();
  drop_all(*end_, now);
}

void PatientProcess::tick(TimePoint now) {
  if (!parts_) {
    // The drive holds the stage where it stands.
    (void)around_.phantom.read(now);
    around_.phantom.halt();
    drop_all(*end_, now);
    return;
  }
  parts_->node.tick(clock_.local(now));
  if (parts_->conversation) parts_->conversation->step(now);
}

link::LinkHealth PatientProcess::health(TimePoint now) const noexcept {
  return parts_ ? parts_->link.health(clock_.local(now)) : link::LinkHealth{};
}

}  // namespace palp::lab
