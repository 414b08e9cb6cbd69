#include "common/link/link.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/common/link/link_couple.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

TEST(LinkTest, RefusesPeriodsItCannotServe) {
  EXPECT_THROW((Link{LinkConfig{.period = 199us}, std::make_unique<RawCodec>()}),
               std::invalid_argument);
  EXPECT_THROW((Link{LinkConfig{.period = 101ms}, std::make_unique<RawCodec>()}),
               std::invalid_argument);
  EXPECT_NO_THROW((Link{LinkConfig{.period = 200us}, std::make_unique<RawCodec>()}));
}

TEST(LinkTest, WithoutASessionNothingHappens) {
  Couple couple;
  couple.run(10ms);
  EXPECT_EQ(couple.surgeon_health().state, LinkState::Down);
  EXPECT_EQ(couple.surgeon_health().sent, 0U);
  EXPECT_FALSE(couple.surgeon.last.peer_heard);
}

TEST(LinkTest, SamplesArriveInOrderWithNumberAndStamps) {
  Couple couple;
  couple.pipe.up->outcome = after(10ms);
  couple.now += 5s;
  couple.connect();
  couple.before_send = [&] {
    couple.surgeon.telegram.port.position = seconds(couple.now.time_since_epoch());
  };
  couple.run(100ms);
  ASSERT_EQ(couple.patient.samples.size(), 90U);
  for (std::uint64_t i = 0; i < 90; ++i) {
    const Incoming& incoming = couple.patient.samples[i];
    const Duration sent = i * 1ms;
    EXPECT_EQ(incoming.number, i);
    EXPECT_TRUE(incoming.fresh);
    EXPECT_FALSE(incoming.repaired);
    EXPECT_EQ(incoming.sent_at.time_since_epoch(), sent);
    EXPECT_EQ(incoming.arrived_at, TimePoint{5s + sent + 10ms});
    EXPECT_EQ(incoming.sample.position, double{static_cast<float>(5 + seconds(sent))});
  }
}

TEST(LinkTest, RepairsALostSampleFromTheTelegramFiveMillisecondsLater) {
  Couple couple;
  couple.pipe.up->outcome = losing({20});
  couple.connect();
  couple.before_send = [&] {
    couple.surgeon.telegram.port.force = seconds(couple.now.time_since_epoch());
    couple.surgeon.telegram.port.payload = WavePayload{seconds(couple.now.time_since_epoch()), 2};
  };
  couple.run(26ms);  // number 25 is sent in the tick that starts at 25 ms
  EXPECT_EQ(couple.patient_health().lost, 1U);
  EXPECT_EQ(couple.patient_health().repaired, 0U);
  couple.tick();
  ASSERT_EQ(couple.patient.samples.size(), 26U);
  const Incoming& repaired = couple.patient.samples[24];
  EXPECT_EQ(repaired.number, 20U);
  EXPECT_TRUE(repaired.repaired);
  EXPECT_FALSE(repaired.fresh);
  EXPECT_EQ(repaired.sent_at.time_since_epoch(), Duration{20ms});
  EXPECT_EQ(repaired.sample.force, double{0.020F});
  EXPECT_EQ(std::get<WavePayload>(repaired.sample.payload).wave_integral, 0.020);
  EXPECT_EQ(couple.patient.samples[25].number, 25U);  // sorted: the repaired one came before
  EXPECT_TRUE(couple.patient.samples[25].fresh);
  EXPECT_EQ(couple.patient_health().repaired, 1U);
  EXPECT_EQ(couple.patient_health().lost, 1U);  // the datagram stays lost
}

TEST(LinkTest, RepairsABurstOfTenMilliseconds) {
  Couple couple;
  couple.pipe.up->outcome = losing({20, 21, 22, 23, 24, 25, 26, 27, 28, 29});
  couple.connect();
  couple.run(60ms);
  EXPECT_EQ(couple.patient.samples.size(), 59U);
  EXPECT_EQ(couple.patient_health().repaired, 10U);
}

TEST(LinkTest, OnlyWaveSumsAreRepeated) {
  Couple couple;
  couple.pipe.up->outcome = losing({20});
  couple.connect();
  couple.surgeon.telegram.port.payload = TdpaPayload{3};
  couple.run(40ms);
  const auto& samples = couple.patient.samples;
  const auto repaired = std::find_if(
      samples.begin(), samples.end(), [](const Incoming& incoming) { return incoming.repaired; });
  ASSERT_NE(repaired, samples.end());
  EXPECT_TRUE(std::holds_alternative<std::monostate>(repaired->sample.payload));
  EXPECT_TRUE(std::holds_alternative<TdpaPayload>(samples.back().sample.payload));
}

TEST(LinkTest, ASkippedPeriodLeavesOutSamplesWhoseTimeWouldBeWrong) {
  Couple couple;
  couple.pipe.up->outcome = losing({19, 22});
  couple.connect();
  couple.run(20ms);   // numbers 0 to 19
  couple.now += 1ms;  // an overrun: 24 would date 19 one period too late
  couple.run(20ms);
  for (const Incoming& incoming : couple.patient.samples) {
    const Duration expected =
        static_cast<std::int64_t>(incoming.number) * 1ms + (incoming.number >= 20 ? 1ms : 0ms);
    EXPECT_EQ(incoming.sent_at.time_since_epoch(), expected) << incoming.number;
  }
  EXPECT_EQ(couple.patient_health().repaired, 1U);  // 22, by 27, both after the overrun
}

TEST(LinkTest, ALateTelegramFillsItsGapAndIsNotFresh) {
  Couple couple;
  couple.pipe.up->outcome = [](std::uint64_t index, const Bytes& bytes) {
    return std::vector<Release>{{index == 20 ? 3500us : 500us, bytes}};
  };
  couple.connect();
  couple.before_send = [&] {
    couple.surgeon.telegram.site.place.x = seconds(couple.now.time_since_epoch());
  };
  couple.run(24ms);
  EXPECT_EQ(couple.patient_health().lost, 1U);
  couple.tick();
  EXPECT_EQ(couple.patient_health().lost, 0U);
  EXPECT_EQ(couple.patient_health().late, 1U);
  EXPECT_EQ(couple.patient_health().reordered, 1U);
  ASSERT_EQ(couple.patient.last.peer.place.x, double{0.023F});  // of the newest, not of the late
  couple.run(10ms);
  EXPECT_EQ(couple.patient_health().repaired, 0U);  // it was handed over already
  EXPECT_EQ(couple.patient.samples.size(), 34U);
  const auto late = std::find_if(couple.patient.samples.begin(),
                                 couple.patient.samples.end(),
                                 [](const Incoming& incoming) { return incoming.number == 20; });
  EXPECT_FALSE(late->fresh);
  EXPECT_FALSE(late->repaired);
}

TEST(LinkTest, TheTelegramAfterAGapIsTheNewest) {
  Couple couple;
  couple.pipe.up->outcome = losing({20, 21, 22});
  couple.connect();
  couple.run(25ms);
  EXPECT_EQ(couple.patient.samples.back().number, 23U);
  EXPECT_TRUE(couple.patient.samples.back().fresh);
  EXPECT_EQ(couple.patient_health().lost, 3U);
}

TEST(LinkTest, SamplesOfAnOldEpochAreDroppedAndTheReportIsUsed) {
  Couple couple;
  couple.pipe.down->outcome = after(20ms);
  couple.connect();
  couple.run(50ms);
  couple.surgeon.telegram.site.epoch = 1;  // engages
  couple.patient.telegram.site.state = SiteState::Stopped;
  couple.surgeon.samples.clear();
  couple.run(25ms);  // the patient follows at 51 ms, which is heard of at 71
  couple.patient.telegram.site.epoch = 1;
  couple.run(15ms);
  EXPECT_EQ(couple.surgeon.last.peer.state, SiteState::Stopped);
  EXPECT_EQ(couple.surgeon.last.accepted, 1U);
  const std::uint64_t handed = couple.surgeon.samples.size();
  EXPECT_EQ(handed, 1U);  // the one received before epoch 1 was sent, in the same tick
  EXPECT_EQ(couple.surgeon_health().old_epoch, 39U);
  couple.run(20ms);
  EXPECT_GT(couple.surgeon.samples.size(), handed);
}

TEST(LinkTest, NoSampleIsRepeatedIntoAnotherEpoch) {
  Couple couple;
  couple.pipe.up->outcome = losing({28, 29});
  couple.connect();
  couple.run(30ms);
  couple.surgeon.telegram.site.epoch = 1;
  couple.run(30ms);
  EXPECT_EQ(couple.patient_health().repaired, 0U);
  EXPECT_EQ(couple.patient_health().old_epoch, 0U);
  EXPECT_EQ(couple.patient.samples.size(), 57U);
}

TEST(LinkTest, SamplesBeforeAnEngagementInTheSameTickAreDropped) {
  Couple couple;
  couple.connect();
  couple.run(20ms);
  // Three telegrams arrive at once: epochs 0, 0, 1.
  for (int i = 0; i < 3; ++i) {
    couple.surgeon.telegram.site.epoch = i == 2 ? 1 : 0;
    couple.surgeon.link.send(couple.surgeon.telegram, couple.now);
  }
  const Arrivals arrivals = couple.patient.link.receive(couple.now);
  ASSERT_EQ(arrivals.samples.size(), 1U);
  EXPECT_EQ(arrivals.samples[0].number, 22U);
  EXPECT_EQ(couple.patient.link.health(couple.now).old_epoch, 3U);
}

TEST(LinkTest, WhatOneOfSeveralTelegramsSaysOfAMapIsNotLost) {
  Couple couple;
  couple.connect();
  couple.run(20ms);
  Telegram& said = couple.patient.telegram;
  const auto send = [&] { couple.patient.link.send(said, couple.now); };
  said.site.map = {.number = 7, .places = 4};
  send();
  said.site.map = {};
  said.site.map_cell = {.number = 7, .index = 2, .count = 9};
  send();
  said.site.map_cell = {};
  send();
  const Arrivals at_once = couple.surgeon.link.receive(couple.now);
  EXPECT_GE(at_once.accepted, 3U);
  EXPECT_EQ(at_once.peer.map.number, 7U);
  EXPECT_EQ(at_once.peer.map_cell.index, 2U);
  send();
  const Arrivals next = couple.surgeon.link.receive(couple.now);
  EXPECT_EQ(next.peer.map.number, 0U) << "of this tick alone";
  EXPECT_EQ(next.peer.map_cell.number, 0U);
}

TEST(LinkTest, RoundTripIsThatOfThePipe) {
  Couple couple;
  couple.pipe.up->outcome = after(30ms);
  couple.pipe.down->outcome = after(12'345us);
  couple.connect();
  couple.run(1s);
  for (const LinkHealth& health : {couple.surgeon_health(), couple.patient_health()}) {
    EXPECT_NEAR(seconds(health.round_trip), 0.042345, 1e-6);
    EXPECT_NEAR(seconds(health.round_trip_min), 0.042345, 1e-6);
    EXPECT_LE(health.jitter, Duration{2us});
  }
}

TEST(LinkTest, JitterShowsInTheDeviationAndNotInTheLeast) {
  Couple couple;
  couple.pipe.up->outcome = [](std::uint64_t index, const Bytes& bytes) {
    return std::vector<Release>{{index / 20 % 2 == 0 ? 10ms : 14ms, bytes}};
  };
  couple.connect();
  couple.run(2s);
  EXPECT_EQ(couple.surgeon_health().round_trip_min, Duration{10ms});
  EXPECT_GT(couple.surgeon_health().jitter, Duration{500us});
}

TEST(LinkTest, OneBudgetPerTick) {
  Couple couple;
  couple.connect();
  couple.run(1ms);
  const LaneEnd flood{*couple.pipe.up, *couple.pipe.down};
  for (int i = 0; i < 600; ++i) {
    couple.pipe.up->push(Bytes(50), couple.now);
  }
  couple.patient.sending = false;
  couple.surgeon.sending = false;
  couple.tick();
  EXPECT_EQ(couple.patient_health().malformed, kDatagramsPerTickMax - 1);  // and one telegram
  couple.run(2ms);
  EXPECT_EQ(couple.patient_health().malformed, 600U);
}

TEST(LinkTest, OverlongDatagramsAreMalformed) {
  Couple couple;
  couple.connect();
  couple.pipe.up->outcome = [](std::uint64_t, Bytes bytes) {
    bytes.resize(kDatagramSizeMax + 1);
    return std::vector<Release>{{Duration{0}, bytes}};
  };
  couple.run(10ms);
  EXPECT_EQ(couple.patient_health().malformed, 9U);
  EXPECT_EQ(couple.patient_health().accepted, 0U);
}

TEST(LinkTest, OtherTypesKeysAndConnectionsAreForeign) {
  Couple couple;
  couple.connect();
  couple.run(5ms);
  const LinkHealth before = couple.patient_health();
  for (const auto& [byte, change] : {std::pair{0U, 1U}, {1U, 0x40U}, {7U, 1U}}) {
    couple.pipe.up->outcome = [byte = byte, change = change](std::uint64_t, Bytes bytes) {
      bytes[byte] ^= static_cast<std::byte>(change);
      return std::vector<Release>{{Duration{0}, bytes}};
    };
    couple.tick();
  }
  couple.surgeon.sending = false;
  couple.tick();
  EXPECT_EQ(couple.patient_health().foreign, before.foreign + 3);
}

TEST(LinkTest, ADuplicateIsReplayedAndAVeryOldOneTooOld) {
  Couple couple;
  Bytes first;
  couple.pipe.up->outcome = [&](std::uint64_t index, const Bytes& bytes) {
    if (index == 0) first = bytes;
    return std::vector<Release>{{Duration{0}, index == 50 ? first : bytes}};
  };
  couple.connect();
  couple.run(52ms);
  EXPECT_EQ(couple.patient_health().replayed, 1U);
  couple.run(1s);
  couple.pipe.up->push(Bytes{}, couple.now);
  couple.pipe.up->outcome = [&](std::uint64_t, const Bytes&) {
    return std::vector<Release>{{Duration{0}, first}};
  };
  couple.tick();
  couple.tick();
  EXPECT_EQ(couple.patient_health().too_old, 1U);
  EXPECT_EQ(couple.patient_health().lost, 1U);  // 50, in whose place 0 came again
}

/// A toy with a 16-byte tag: the sum of all bytes, as often as it fits.
class TaggedProtection final : public PacketProtection {
 public:
  static constexpr std::size_t kTag = 16;
  [[nodiscard]] std::size_t overhead() const noexcept override { return kTag; }
  std::size_t seal(const Header& header,
                   std::span<const std::byte> plain,
                   std::span<std::byte> out) noexcept override {
    Header complete = header;
    complete.length = static_cast<std::uint16_t>(plain.size() + kTag);
    pack_header(complete, out.first<kHeaderSize>());
    std::copy(plain.begin(), plain.end(), out.begin() + kHeaderSize);
    const std::size_t body = kHeaderSize + plain.size();
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(body), kTag, sum(out.first(body)));
    return body + kTag;
  }
  tl::expected<Header, Rejection> read_header(
      std::span<const std::byte> datagram) noexcept override {
    const auto header = parse_header(datagram);
    if (!header || header->length < kTag) return tl::unexpected(Rejection::Malformed);
    return *header;
  }
  tl::expected<std::size_t, Rejection> open(const Header& /*header*/,
                                            std::span<const std::byte> datagram,
                                            std::span<std::byte> plain) noexcept override {
    const auto body = datagram.first(datagram.size() - kTag);
    for (const std::byte tag : datagram.last(kTag)) {
      if (tag != sum(body)) return tl::unexpected(Rejection::Forged);
    }
    const auto payload = body.subspan(kHeaderSize);
    std::copy(payload.begin(), payload.end(), plain.begin());
    return payload.size();
  }

 private:
  static std::byte sum(std::span<const std::byte> bytes) {
    unsigned total = 7;
    for (const std::byte b : bytes) total = total * 31 + std::to_integer<unsigned>(b);
    return static_cast<std::byte>(total >> 3U & 0xFFU);
  }
};

TEST(LinkTest, AForgedDatagramLeavesNoTraceButItsCounter) {
  Couple couple;
  couple.connect();
  for (Side* side : {&couple.surgeon, &couple.patient}) {
    LinkUpdate keys{.transport = nullptr,
                    .protection = std::make_unique<TaggedProtection>(),
                    .send_connection = side == &couple.surgeon ? 3U : 2U,
                    .receive_connection = side == &couple.surgeon ? 2U : 3U,
                    .session_id = 1};
    (void)side->link.adopt(std::move(keys), couple.now);
  }
  // Before each genuine datagram a forged one, same number or far ahead.
  couple.pipe.up->outcome = [](std::uint64_t index, const Bytes& bytes) {
    Bytes forged = bytes;
    forged[index % 2 == 0 ? kHeaderSize : 10] ^= std::byte{0x10};
    return std::vector<Release>{{Duration{0}, forged}, {Duration{0}, bytes}};
  };
  couple.run(100ms);
  const LinkHealth health = couple.patient_health();
  EXPECT_EQ(health.forged, 99U);
  EXPECT_EQ(health.accepted, 99U);
  EXPECT_EQ(health.replayed + health.too_old + health.lost + health.late, 0U);
}

TEST(LinkTest, AnAuthenticTelegramThatIsNotWellFormedIsMalformed) {
  Couple couple;
  couple.connect();
  couple.pipe.up->outcome = [](std::uint64_t index, Bytes bytes) {
    if (index == 5) bytes[kHeaderSize] = std::byte{0x7F};
    return std::vector<Release>{{Duration{0}, bytes}};
  };
  couple.run(10ms);
  EXPECT_EQ(couple.patient_health().malformed, 1U);
  EXPECT_EQ(couple.patient_health().accepted, 8U);
  EXPECT_EQ(couple.patient_health().lost, 0U);  // it came
}

TEST(LinkTest, ANodeThatSaysNonsenseIsNotSent) {
  Couple couple;
  couple.connect();
  couple.surgeon.telegram.port.force = std::nan("");
  couple.run(10ms);
  EXPECT_EQ(couple.surgeon_health().unsent, 10U);
  EXPECT_EQ(couple.surgeon_health().sent, 0U);
  EXPECT_EQ(couple.pipe.up->pushed(), 0U);
}

TEST(LinkTest, ARefusedSendIsCountedAndCostsANumber) {
  class Refusing final : public Transport {
   public:
    bool send(std::span<const std::byte>, TimePoint) noexcept override { return false; }
    std::optional<Datagram> receive(std::span<std::byte, kDatagramSizeMax>,
                                    TimePoint) noexcept override {
      return std::nullopt;
    }
  };
  Link link{LinkConfig{}, std::make_unique<RawCodec>()};
  (void)link.adopt(Couple::link_update(std::make_unique<Refusing>(), 1, 2, 3), TimePoint{});
  link.send({}, TimePoint{});
  EXPECT_EQ(link.health(TimePoint{}).unsent, 1U);
  EXPECT_EQ(link.health(TimePoint{}).sent, 1U);
}

}  // namespace
}  // namespace palp::link
