// Two Links whose telegrams are sealed: what strangers can do, and that no nonce comes twice.
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "common/link/aead_protection.h"
#include "tests/common/link/link_couple.h"
#include "tests/common/link/some_keys.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

/// A Couple with keys, which can be replaced while telegrams flow.
class SealedCouple : public Couple {
 public:
  SealedCouple() : Couple{LinkConfig{}} {
    adopt(surgeon, surgeon_end(), keys(Role::Surgeon), 3, 2);
    adopt(patient, patient_end(), keys(Role::Patient), 2, 3);
  }
  /// As io does once a second handshake inside the session has ended: the patient is first.
  void rekey() {
    ++handshake_;
    give(patient, changeover(Role::Patient, AeadProtection::Lead::Peer), 2, 3);
    run(5ms);
    give(surgeon, changeover(Role::Surgeon, AeadProtection::Lead::Own), 3, 2);
    run(20ms);
    give(patient, keys(Role::Patient), 2, 3);
    give(surgeon, keys(Role::Surgeon), 3, 2);
  }
  [[nodiscard]] std::uint64_t handshake() const { return handshake_; }
  [[nodiscard]] static TrafficKeys keys_of(std::uint64_t handshake, Role role) {
    return some_keys(handshake, role, static_cast<std::uint8_t>(handshake % 4)).data;
  }

 private:
  [[nodiscard]] std::unique_ptr<Transport> surgeon_end() const { return pipe.surgeon_end(); }
  [[nodiscard]] std::unique_ptr<Transport> patient_end() const { return pipe.patient_end(); }
  [[nodiscard]] std::unique_ptr<PacketProtection> keys(Role role) const {
    return std::make_unique<AeadProtection>(keys_of(handshake_, role));
  }
  [[nodiscard]] std::unique_ptr<PacketProtection> changeover(Role role,
                                                             AeadProtection::Lead lead) const {
    return std::make_unique<AeadProtection>(
        keys_of(handshake_ - 1, role), keys_of(handshake_, role), lead);
  }
  void adopt(Side& side,
             std::unique_ptr<Transport> transport,
             std::unique_ptr<PacketProtection> protection,
             std::uint32_t send,
             std::uint32_t receive) {
    (void)side.link.adopt({.transport = std::move(transport),
                           .protection = std::move(protection),
                           .send_connection = send,
                           .receive_connection = receive,
                           .session_id = 1},
                          now);
  }
  void give(Side& side,
            std::unique_ptr<PacketProtection> protection,
            std::uint32_t send,
            std::uint32_t receive) {
    adopt(side, nullptr, std::move(protection), send, receive);
  }
  std::uint64_t handshake_{1};
};

TEST(SealedLinkTest, TelegramsFlow) {
  SealedCouple couple;
  couple.run(1s);
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
  EXPECT_EQ(couple.surgeon_health().state, LinkState::Live);
  EXPECT_EQ(couple.patient_health().lost, 0U);
  EXPECT_EQ(couple.patient_health().forged, 0U);
}

TEST(SealedLinkTest, WarmUpsChangeNothingThatIsSentOrCounted) {
  std::array<std::vector<Bytes>, 2> sent;
  std::array<LinkHealth, 2> health;
  for (const std::size_t warms_up : {0U, 1U}) {
    SealedCouple couple;
    couple.pipe.up->outcome = [&](std::uint64_t, const Bytes& bytes) {
      sent[warms_up].push_back(bytes);
      return std::vector<Release>{{2ms, bytes}};
    };
    couple.before_send = [&] {
      for (std::size_t i = 0; i < warms_up; ++i) couple.surgeon.link.warm_up();
      for (std::size_t i = 0; i < warms_up; ++i) couple.patient.link.warm_up();
    };
    couple.run(50ms);
    health[warms_up] = couple.patient_health();
  }
  EXPECT_EQ(sent[0], sent[1]);
  EXPECT_EQ(health[0].accepted, health[1].accepted);
  EXPECT_EQ(health[1].forged + health[1].malformed + health[1].unsent, 0U);
}

TEST(SealedLinkTest, ManyRekeysCostNoTelegramAndNoNonceComesTwice) {
  SealedCouple couple;
  // A key is told apart by handshake and direction: only one generation of an id is in use at once.
  std::set<std::tuple<bool, std::uint64_t, std::uint64_t>> nonces;
  std::uint64_t sealed = 0;
  for (const bool up : {true, false}) {
    (up ? couple.pipe.up : couple.pipe.down)->outcome = [&, up](std::uint64_t, const Bytes& bytes) {
      std::uint64_t handshake = couple.handshake();
      if (parse_clear_part(bytes)->key != handshake % 4) --handshake;
      AeadProtection receiver{SealedCouple::keys_of(handshake, up ? Role::Patient : Role::Surgeon)};
      const Header header = receiver.read_header(bytes).value();
      EXPECT_EQ(header.connection, up ? 3U : 2U);
      nonces.emplace(up, handshake, header.number);
      ++sealed;
      return std::vector<Release>{{Duration{3ms}, bytes}};
    };
  }
  couple.run(100ms);
  for (int i = 0; i < 50; ++i) {
    couple.rekey();
    couple.run(1s);
  }
  EXPECT_GT(sealed, 100'000U);
  EXPECT_EQ(nonces.size(), sealed);
  for (const LinkHealth& health : {couple.patient_health(), couple.surgeon_health()}) {
    EXPECT_EQ(health.forged + health.foreign + health.lost + health.replayed, 0U);
    EXPECT_EQ(health.state, LinkState::Live);
  }
}

TEST(SealedLinkTest, AWholeRecordedSessionPlayedAgainIsRefused) {
  SealedCouple couple;
  std::vector<Bytes> recorded;
  couple.pipe.up->outcome = [&](std::uint64_t, const Bytes& bytes) {
    recorded.push_back(bytes);
    return std::vector<Release>{{Duration{0}, bytes}};
  };
  couple.run(3s);
  const LinkHealth before = couple.patient_health();
  const std::size_t samples = couple.patient.samples.size();
  couple.surgeon.sending = false;
  const std::vector<Bytes> all = recorded;
  couple.pipe.up->outcome = after(Duration{0});
  for (std::size_t i = 0; i < all.size(); ++i) {
    couple.pipe.up->push(all[i], couple.now);
    if (i % 100 == 99) couple.tick();
  }
  couple.run(5ms);
  const LinkHealth health = couple.patient_health();
  // The last one or two of the recording may still have been on their way.
  EXPECT_LE(health.accepted - before.accepted, 2U);
  EXPECT_LE(couple.patient.samples.size(), samples + 2);
  EXPECT_EQ(health.replayed + health.too_old - before.replayed - before.too_old, all.size());
}

TEST(SealedLinkTest, SpoiledTelegramsAreRefusedAndChangeNothing) {
  SealedCouple couple;
  couple.run(1s);
  const LinkHealth before = couple.patient_health();
  couple.pipe.up->outcome = [](std::uint64_t index, const Bytes& bytes) {
    Bytes spoiled = bytes;
    spoiled[kHeaderSize + index % (bytes.size() - kHeaderSize)] ^= std::byte{1};
    return std::vector<Release>{{Duration{0}, spoiled}};
  };
  const std::size_t samples = couple.patient.samples.size();
  couple.run(1s);
  const LinkHealth health = couple.patient_health();
  // A spoiled tag makes another mask, and the header anybody's.
  EXPECT_GE(health.forged + health.foreign - before.forged - before.foreign, 998U);
  EXPECT_LE(health.accepted - before.accepted, 1U);
  EXPECT_LE(couple.patient.samples.size(), samples + 1);
  EXPECT_EQ(health.state, LinkState::Lost);
}

TEST(SealedLinkTest, KeysForASessionThatHasEndedComeBackUnused) {
  SealedCouple couple;
  couple.run(100ms);
  couple.pipe.up->outcome = kCut;
  couple.pipe.down->outcome = kCut;
  couple.run(31s);
  ASSERT_EQ(couple.patient_health().session_id, 0U);
  const LinkUpdate retired = couple.patient.link.adopt(
      {.transport = nullptr,
       .protection = std::make_unique<AeadProtection>(some_keys(1, Role::Patient, 1).data),
       .send_connection = 2,
       .receive_connection = 3,
       .session_id = 1,
       .continues = true},
      couple.now);
  EXPECT_NE(retired.protection, nullptr) << "its numbers would begin at 0 again";
  couple.run(5ms);
  EXPECT_EQ(couple.patient_health().session_id, 0U);
}

TEST(SealedLinkTest, AForgedJumpAheadDoesNotMoveTheWindow) {
  SealedCouple couple;
  couple.run(100ms);
  couple.pipe.up->outcome = [](std::uint64_t, const Bytes& bytes) {
    Bytes forged = bytes;
    forged[11] ^= std::byte{1};  // number + 2^32, through the mask
    return std::vector<Release>{{Duration{0}, forged}, {Duration{0}, bytes}};
  };
  couple.run(1s);
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
  EXPECT_GE(couple.patient_health().forged, 999U);
  EXPECT_EQ(couple.patient_health().too_old, 0U);
}

}  // namespace
}  // namespace palp::link
