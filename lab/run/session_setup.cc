#include "lab/run/session_setup.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/core/random.h"
#include "common/link/packet_protection.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kEntropyStream = 0x656e'7472'6f70'0000ULL;  ///< "entrop": ids of sessions

constexpr std::uint64_t kSessionStream = 0x7365'7373'696f'6e00ULL;  ///< "session"

/// Where clocks step there are two of them, both long since started: none may fall below 0.
constexpr Duration kSurgeonAhead = std::chrono::hours{1};
constexpr Duration kPatientAhead = std::chrono::hours{7};

bool by_handshake(const Scenario& scenario) { return scenario.fault.kind != FaultKind::None; }

DeviceFacts devices_of(const Scenario& scenario, link::Role role) {
  if (role == link::Role::Surgeon) {
    return {.hand = hand_facts_of(scenario), .stage = {}, .sensor = {}};
  }
  const PatientDevices devices = patient_devices_of(scenario);
  return {.hand = {}, .stage = devices.stage, .sensor = devices.sensor};
}

link::Role other(link::Role role) {
  return role == link::Role::Surgeon ? link::Role::Patient : link::Role::Surgeon;
}

/// A session as the handshake would have left it.
link::LinkUpdate link_update(std::unique_ptr<link::Transport> transport,
                             const DeviceFacts& peer,
                             std::uint64_t session_id) {
  return {.transport = std::move(transport),
          .protection = std::make_unique<link::PlainProtection>(),
          .send_connection = 1,
          .receive_connection = 1,
          .session_id = session_id,
          .peer_devices = peer};
}

/// The same at both sites and in each run of the scenario, another one in any other.
std::uint64_t session_id_of(const Scenario& scenario) {
  Digest text;
  for (const char letter : scenario.text) text.add(static_cast<std::uint64_t>(letter));
  return std::max<std::uint64_t>(1, random_bits(scenario.seed, kSessionStream, text.value()));
}

}  // namespace

LocalClock clock_of(const Scenario& scenario, link::Role role) noexcept {
  if (!by_handshake(scenario)) return {};
  return {role == link::Role::Surgeon ? kSurgeonAhead : kPatientAhead};
}

SessionSetup::SessionSetup(const Scenario& scenario,
                           link::Role role,
                           std::unique_ptr<link::Transport> end)
    : scenario_{scenario}, role_{role}, end_{std::move(end)}, clock_{clock_of(scenario, role)} {}

void SessionSetup::start(link::Link& link, TimePoint now) {
  if (!by_handshake(scenario_)) {
    (void)link.adopt(
        link_update(std::move(end_), devices_of(scenario_, other(role_)), session_id_of(scenario_)),
        now);
    return;
  }
  // Another 64 bits for every start.
  const std::uint64_t entropy =
      random_bits(scenario_.seed, kEntropyStream + static_cast<std::uint64_t>(role_), starts_++);
  const link::SessionConfig config{.role = role_,
                                   .coupling = scenario_.coupling.name,
                                   .git = {},
                                   .devices = devices_of(scenario_, role_)};
  lab_session_.emplace(config, entropy, *end_, clock_, link);
}

void SessionSetup::step(TimePoint now) {
  if (lab_session_) lab_session_->step(now);
}

void SessionSetup::kill(TimePoint now) {
  lab_session_.reset();
  lose(now);
}

void SessionSetup::lose(TimePoint now) {
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  while (end_->receive(buffer, now)) continue;
}

}  // namespace palp::lab
