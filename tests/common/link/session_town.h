#pragma once

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/link/packet_protection.h"
#include "common/link/session.h"
#include "tests/common/link/test_pipe.h"

/// A surgeon and a patient that look for each other in virtual time, with what a Link would say.
namespace palp::link {

using std::chrono_literals::operator""ms;

inline SessionConfig config_of(Role role) {
  return {.role = role, .settings_hash = 77, .coupling = "direct", .git = "abc"};
}

/// A Session, what its Link is said to be, and what it told.
struct Party {
  Session session;
  LinkState state{LinkState::Down};
  std::uint64_t link_session{};
  std::vector<Established> established;
  std::vector<Refused> refused;
  std::vector<Closed> closed;
  Lane* out{};
  bool hands_over{true};  ///< false: its Link has not heard of the session yet

  Party(const SessionConfig& config, std::uint64_t entropy) : session{config, entropy} {}

  void take(const SessionOutput& output, TimePoint now) {
    for (const ControlBytes& datagram : output.datagrams) out->push(datagram.view(), now);
    if (!output.event) return;
    if (const auto* event = std::get_if<Established>(&*output.event)) {
      established.push_back(*event);
      if (hands_over) link_session = event->session_id;  // as io does with the Link
      state = LinkState::Down;
    } else if (const auto* refusal = std::get_if<Refused>(&*output.event)) {
      refused.push_back(*refusal);
    } else {
      closed.push_back(std::get<Closed>(*output.event));
      link_session = 0;
      state = LinkState::Down;
    }
  }
};

/// One patient, surgeons that come and go; each surgeon has its own way to the patient.
class Town {
 public:
  TimePoint now{};
  Lane up;
  Lane down;
  std::unique_ptr<Party> surgeon;
  std::unique_ptr<Party> patient;

  explicit Town(const SessionConfig& surgeon_config = config_of(Role::Surgeon),
                const SessionConfig& patient_config = config_of(Role::Patient)) {
    start_surgeon(1, surgeon_config);
    start_patient(2, patient_config);
  }
  void start_surgeon(std::uint64_t entropy,
                     const SessionConfig& config = config_of(Role::Surgeon)) {
    surgeon = std::make_unique<Party>(config, entropy);
    surgeon->out = &up;
  }
  void start_patient(std::uint64_t entropy,
                     const SessionConfig& config = config_of(Role::Patient)) {
    patient = std::make_unique<Party>(config, entropy);
    patient->out = &down;
  }

  void run(Duration span) {
    for (const TimePoint end = now + span; now < end; now += 1ms) {
      if (patient) {
        while (auto datagram = up.pop(now)) {
          patient->take(patient->session.on_datagram(datagram->second, now), now);
        }
        patient->take(patient->session.tick(now, patient->state, patient->link_session), now);
      }
      if (surgeon) {
        while (auto datagram = down.pop(now)) {
          surgeon->take(surgeon->session.on_datagram(datagram->second, now), now);
        }
        surgeon->take(surgeon->session.tick(now, surgeon->state, surgeon->link_session), now);
      }
    }
  }
  /// As the Links would after their exchanges.
  void both(LinkState state) {
    if (surgeon->session.established()) surgeon->state = state;
    if (patient->session.established()) patient->state = state;
  }
  void expect_one_session() const {
    ASSERT_FALSE(surgeon->established.empty());
    ASSERT_FALSE(patient->established.empty());
    const Established& s = surgeon->established.back();
    const Established& p = patient->established.back();
    EXPECT_EQ(s.session_id, p.session_id);
    EXPECT_EQ(s.send_connection, p.receive_connection);
    EXPECT_EQ(p.send_connection, s.receive_connection);
    EXPECT_NE(s.send_connection, s.receive_connection);
    EXPECT_NE(s.session_id, 0U);
    EXPECT_NE(s.send_connection, 0U);
    EXPECT_NE(s.receive_connection, 0U);
  }
};

/// A control message with its header.
inline Bytes datagram_of(PacketType type, const ControlBytes& message) {
  Bytes bytes(kControlSizeMax + kHeaderSize);
  bytes.resize(PlainProtection{}.seal({.type = type}, message.view(), bytes));
  return bytes;
}

}  // namespace palp::link
