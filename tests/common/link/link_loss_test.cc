#include <map>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"
#include "tests/common/link/link_couple.h"
#include "tests/common/link/some_telegram.h"

// Laws that hold whatever the path does.
namespace palp::link {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

enum class Stream : std::uint64_t { Loss, Copy, Delay, Spoil, Place };

double chance(std::uint64_t seed, Stream stream, std::uint64_t index) {
  return random_uniform(seed, static_cast<std::uint64_t>(stream), index);
}

/// 5 % lost, 5 % doubled, 4 % spoiled, 0 to 8 ms late; `spoil` changes the bytes.
PacketOutcome bad_path(std::uint64_t seed,
                       const std::function<void(std::uint64_t, Bytes&)>& spoil) {
  return [=](std::uint64_t index, const Bytes& bytes) {
    std::vector<Release> releases;
    if (chance(seed, Stream::Loss, index) < 0.05) return releases;
    const auto delay = [&](std::uint64_t copy) {
      return 5ms + from_seconds(0.008 * chance(seed, Stream::Delay, 2 * index + copy));
    };
    releases.push_back({delay(0), bytes});
    if (chance(seed, Stream::Copy, index) < 0.05) releases.push_back({delay(1), bytes});
    if (chance(seed, Stream::Spoil, index) < 0.04) spoil(index, releases[0].bytes);
    return releases;
  };
}

std::uint64_t arrivals_counted(const LinkHealth& health) {
  return health.accepted + health.late + health.stale + health.malformed + health.foreign +
         health.replayed + health.too_old + health.forged;
}

RC_GTEST_PROP(LinkLossTest, EveryArrivalIsCountedOnceWhateverWasFlipped, (std::uint64_t seed)) {
  const auto flip_or_cut = [=](std::uint64_t index, Bytes& bytes) {
    const std::uint64_t place = random_bits(seed, 99, index);
    if (place % 3 == 0) {
      bytes.resize(place % bytes.size());
    } else {
      bytes[place / 8 % bytes.size()] ^= static_cast<std::byte>(1U << place % 8);
    }
  };
  Couple couple;
  couple.pipe.up->outcome = bad_path(seed, flip_or_cut);
  couple.pipe.down->outcome = bad_path(seed + 1, flip_or_cut);
  couple.connect();
  couple.run(300ms);
  RC_ASSERT(arrivals_counted(couple.patient_health()) == couple.pipe.up->popped());
  RC_ASSERT(arrivals_counted(couple.surgeon_health()) == couple.pipe.down->popped());
}

RC_GTEST_PROP(LinkLossTest, NumbersSentAreAcceptedLateStaleOrLost, (std::uint64_t seed)) {
  Couple couple;
  // Flips in the first 8 bytes only: without a tag nobody notices a flipped number.
  couple.pipe.up->outcome = bad_path(seed, [=](std::uint64_t index, Bytes& bytes) {
    const std::uint64_t place = random_bits(seed, 99, index) % 64;
    bytes[place / 8] ^= static_cast<std::byte>(1U << place % 8);
  });
  couple.connect();
  couple.run(300ms);
  couple.pipe.up->outcome = after(0ms);  // the last one arrives
  couple.run(20ms);
  couple.surgeon.sending = false;
  couple.run(20ms);
  const LinkHealth health = couple.patient_health();
  RC_ASSERT(couple.surgeon_health().sent == 320U);
  RC_ASSERT(health.accepted + health.late + health.stale + health.lost == 320U);
  RC_ASSERT(health.reordered == health.late);

  std::set<std::uint64_t> numbers;
  std::uint64_t fresh = 0;
  std::uint64_t repaired = 0;
  for (const Incoming& incoming : couple.patient.samples) {
    RC_ASSERT(numbers.insert(incoming.number).second);  // handed over at most once
    RC_ASSERT(incoming.sent_at.time_since_epoch() ==
              1ms * static_cast<std::int64_t>(incoming.number));
    RC_ASSERT(incoming.sample.position == 0.0);
    fresh += incoming.fresh ? 1 : 0;
    repaired += incoming.repaired ? 1 : 0;
  }
  RC_ASSERT(fresh == health.accepted);
  RC_ASSERT(repaired == health.repaired);
}

RC_GTEST_PROP(LinkLossTest, EachCallHandsOverSortedSamples, (std::uint64_t seed)) {
  Couple couple;
  couple.pipe.up->outcome = bad_path(seed, [](std::uint64_t, Bytes&) {});
  couple.connect();
  std::uint64_t newest = 0;
  for (int tick = 0; tick < 300; ++tick) {
    const Arrivals arrivals = couple.patient.link.receive(couple.now);
    couple.surgeon.link.send({}, couple.now);
    couple.now += 1ms;
    for (std::size_t i = 1; i < arrivals.samples.size(); ++i) {
      RC_ASSERT(arrivals.samples[i - 1].number < arrivals.samples[i].number);
    }
    for (const Incoming& incoming : arrivals.samples) {
      if (!incoming.fresh) continue;
      RC_ASSERT(incoming.number >= newest);
      newest = incoming.number + 1;
    }
  }
}

RC_GTEST_PROP(LinkLossTest,
              WhateverIsHandedOverWasSentAtThatTimeUnderThatNumber,
              (std::uint64_t seed)) {
  const Duration period = *rc::gen::element<Duration>(250us, 500us, 1ms, 2ms, 4ms, 7ms);
  Couple couple{{.period = period}};
  couple.pipe.up->outcome = bad_path(seed, [](std::uint64_t, Bytes& bytes) { bytes.clear(); });
  couple.connect();
  const TimePoint began = couple.now;
  std::map<std::uint64_t, std::pair<double, TimePoint>> sent;  // by number
  couple.before_send = [&] {
    const std::uint64_t number = sent.size();
    // A float has room for these.
    couple.surgeon.telegram.port.position = static_cast<double>(number % 4096) / 1024;
    couple.surgeon.telegram.site.epoch = static_cast<std::uint32_t>(number / 100);
    sent[number] = {couple.surgeon.telegram.port.position, couple.now};
  };
  for (int tick = 0; tick < 400; ++tick) {
    couple.tick();
    const double skips = random_uniform(seed, 77, static_cast<std::uint64_t>(tick));
    if (skips < 0.03) couple.now += period * static_cast<int>(1 + 200 * skips);  // missed periods
  }
  std::set<std::uint64_t> numbers;
  std::uint64_t repaired = 0;
  for (const Incoming& incoming : couple.patient.samples) {
    RC_ASSERT(numbers.insert(incoming.number).second);
    const auto& [position, at] = sent.at(incoming.number);
    RC_ASSERT(incoming.sample.position == position);
    const Duration off = incoming.sent_at.time_since_epoch() - (at - began);
    RC_ASSERT(std::chrono::abs(off) <= (incoming.repaired ? period / 2 : Duration{0}));
    repaired += incoming.repaired ? 1 : 0;
  }
  RC_ASSERT(repaired == couple.patient_health().repaired);
  RC_ASSERT(numbers.size() > 200U);
}

TEST(LinkLossTest, RepetitionLeavesNextToNothingMissingAtRandomLoss) {
  Couple couple{LinkConfig{}, true};
  couple.pipe.up->outcome = [](std::uint64_t index, const Bytes& bytes) {
    if (chance(3, Stream::Loss, index) < 0.05) return std::vector<Release>{};
    return std::vector<Release>{{2ms, bytes}};
  };
  couple.connect();
  // 0.05^3 of the samples: 0.0125 %.
  constexpr std::int64_t kSamples = 100'000;
  couple.patient.samples.reserve(kSamples);
  couple.run(1ms * kSamples);
  const auto handed = static_cast<double>(couple.patient.samples.size());
  EXPECT_LE(1.0 - (handed + 2) / kSamples, 2e-4);
  EXPECT_NEAR(static_cast<double>(couple.patient_health().lost) / kSamples, 0.05, 0.003);
}

TEST(LinkLossTest, ACleanStreamWithKnownLossesCountsThemExactly) {
  Couple couple;
  couple.pipe.up->outcome = [](std::uint64_t index, const Bytes& bytes) {
    if (index % 10 == 3) return std::vector<Release>{};
    return std::vector<Release>{{Duration{0}, bytes}};
  };
  couple.connect();
  couple.run(1001ms);  // numbers 0 to 999 have arrived
  EXPECT_EQ(couple.patient_health().lost, 100U);
  EXPECT_EQ(couple.patient_health().accepted, 900U);
}

TEST(LinkLossTest, ABlackoutIsLostAtOnceWhenItEnds) {
  Couple couple;
  couple.connect();
  couple.run(100ms);
  couple.pipe.up->outcome = [](std::uint64_t, const Bytes&) { return std::vector<Release>{}; };
  couple.run(2s);
  EXPECT_EQ(couple.patient_health().lost, 0U);  // not known yet
  couple.pipe.up->outcome = after(0ms);
  couple.run(2ms);
  EXPECT_EQ(couple.patient_health().lost, 2000U);
}

TEST(LinkLossTest, OneSeedTwiceGivesTheSame) {
  const auto run = [](std::uint64_t seed) {
    Couple couple;
    couple.pipe.up->outcome = bad_path(seed, [](std::uint64_t, Bytes& bytes) { bytes.pop_back(); });
    couple.connect();
    couple.run(500ms);
    std::vector<std::pair<std::uint64_t, TimePoint>> handed;
    for (const Incoming& incoming : couple.patient.samples) {
      handed.emplace_back(incoming.number, incoming.arrived_at);
    }
    return handed;
  };
  EXPECT_EQ(run(7), run(7));
  EXPECT_NE(run(7), run(8));
}

}  // namespace
}  // namespace palp::link
