#include "common/link/codec.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/link/codec_wire.h"
#include "proto/link.pb.h"
#include "tests/common/link/some_telegram.h"
#include "tests/common/message/same.h"

namespace palp::link {
namespace {

using message::same;

std::vector<std::byte> encoded(Codec& codec, const WireTelegram& telegram) {
  std::vector<std::byte> bytes(message::kTelegramSizeMax);
  bytes.resize(codec.encode(telegram, std::span<std::byte, message::kTelegramSizeMax>{bytes}));
  return bytes;
}

std::span<const std::byte> view(const std::string& bytes) {
  return std::as_bytes(std::span{bytes});
}

RC_GTEST_PROP(WireCodecTest, DecodesExactlyWhatWasEncoded, (std::uint64_t seed)) {
  WireCodec codec;
  const WireTelegram sent = some_telegram(seed);
  const auto bytes = encoded(codec, sent);
  RC_ASSERT(!bytes.empty());
  const auto received = codec.decode(bytes);
  RC_ASSERT(received.has_value());
  RC_ASSERT(same(*received, rounded_as_on_wire(sent)));
  RC_ASSERT(encoded(codec, *received) == bytes);
}

RC_GTEST_PROP(RawCodecTest, DecodesExactlyWhatWasEncoded, (std::uint64_t seed)) {
  RawCodec codec;
  const WireTelegram sent = some_telegram(seed);
  const auto received = codec.decode(encoded(codec, sent));
  RC_ASSERT(received.has_value());
  RC_ASSERT(same(*received, sent));
}

RC_GTEST_PROP(CodecTest, WhatDecodesIsWellFormedWhateverBitsWereFlipped, (std::uint64_t seed)) {
  WireCodec wire_codec;
  RawCodec raw;
  message::Draw draw{seed + 1};
  for (Codec* codec : std::initializer_list<Codec*>{&wire_codec, &raw}) {
    auto bytes = encoded(*codec, some_telegram(seed));
    const std::uint64_t flips = 1 + draw.below(8);
    for (std::uint64_t i = 0; i < flips; ++i) {
      const std::uint64_t bit = draw.below(8 * bytes.size());
      bytes[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    }
    if (const auto received = codec->decode(bytes)) {
      RC_ASSERT(well_formed(*received));
      RC_ASSERT(same(codec->decode(encoded(*codec, *received)).value(), *received));
    }
  }
}

RC_GTEST_PROP(CodecTest, SurvivesRandomBytes, (const std::vector<std::uint8_t>& junk)) {
  WireCodec wire_codec;
  RawCodec raw;
  const auto bytes = std::as_bytes(std::span{junk});
  if (const auto received = wire_codec.decode(bytes)) RC_ASSERT(well_formed(*received));
  if (const auto received = raw.decode(bytes)) RC_ASSERT(well_formed(*received));
}

TEST(WireCodecTest, RefusesEveryTruncation) {
  WireCodec codec;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto bytes = encoded(codec, some_telegram(seed));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const auto received = codec.decode(std::span{bytes}.first(size));
      // A cut between fields leaves a shorter message, which must still be a whole one.
      if (received) {
        EXPECT_TRUE(well_formed(*received));
        EXPECT_LT(received->older_count, 2U);
      }
    }
  }
}

/// A message with site and sample, to be spoiled in one way.
wire::Telegram plain_message() {
  wire::Telegram message;
  message.mutable_site();
  message.mutable_sample();
  return message;
}

TEST(WireCodecTest, RefusesMessagesWithoutSiteOrSample) {
  WireCodec codec;
  EXPECT_TRUE(codec.decode(view(plain_message().SerializeAsString())));
  auto message = plain_message();
  message.clear_site();
  EXPECT_FALSE(codec.decode(view(message.SerializeAsString())));
  message = plain_message();
  message.clear_sample();
  EXPECT_FALSE(codec.decode(view(message.SerializeAsString())));
}

TEST(WireCodecTest, RefusesUnknownFieldsAtEveryDepth) {
  WireCodec codec;
  const std::string unknown{"\x78\x01", 2};  // field 15, varint 1
  ASSERT_FALSE(codec.decode(view(plain_message().SerializeAsString() + unknown)));

  // By hand: telegram { site {} sample { wave { <unknown> } } }.
  const std::string wave{"\x22\x02\x78\x01", 4};
  const std::string sample = std::string{"\x3A\x04", 2} + wave;
  EXPECT_FALSE(codec.decode(view(std::string{"\x32\x00", 2} + sample)));
  const std::string empty_wave{"\x32\x00\x3A\x02\x22\x00", 6};
  EXPECT_TRUE(codec.decode(view(empty_wave)));
}

TEST(WireCodecTest, RefusesRepeatedFieldsAndTwoPayloads) {
  WireCodec codec;
  const std::string once = plain_message().SerializeAsString();
  EXPECT_FALSE(codec.decode(view(once + once)));
  // sample { wave {} tdpa {} }: the parser would keep the last and pay for both.
  EXPECT_FALSE(codec.decode(view({"\x32\x00\x3A\x04\x22\x00\x2A\x00", 8})));
  EXPECT_TRUE(codec.decode(view({"\x32\x00\x3A\x02\x2A\x00", 6})));
}

TEST(WireCodecTest, RefusesAFieldInAnotherWireType) {
  WireCodec codec;
  EXPECT_FALSE(codec.decode(view({"\x32\x00\x3A\x00\x0D\x01\x02\x03\x04", 9})));  // sent_at fixed32
  EXPECT_FALSE(codec.decode(view({"\x32\x00\x3A\x00\x0B\x0C", 6})));              // groups
}

TEST(WireCodecTest, RefusesTheSecondEarlierSampleWithoutTheFirst) {
  WireCodec codec;
  auto message = plain_message();
  message.mutable_sample_second_earlier();
  EXPECT_FALSE(codec.decode(view(message.SerializeAsString())));
  message.mutable_sample_first_earlier();
  EXPECT_TRUE(codec.decode(view(message.SerializeAsString())));
  message.mutable_sample_first_earlier()->mutable_tdpa();
  EXPECT_FALSE(codec.decode(view(message.SerializeAsString())));
}

TEST(WireCodecTest, RefusesEnumeratorsOutOfRange) {
  WireCodec codec;
  auto message = plain_message();
  message.mutable_site()->set_state(static_cast<shared::SiteState>(5));
  EXPECT_TRUE(codec.decode(view(message.SerializeAsString())));
  for (const int bad : {6, 255, 256, 262, -1}) {
    message.mutable_site()->set_state(static_cast<shared::SiteState>(bad));
    EXPECT_FALSE(codec.decode(view(message.SerializeAsString()))) << bad;
  }
  message = plain_message();
  message.mutable_site()->mutable_depth()->set_number(1);
  EXPECT_TRUE(codec.decode(view(message.SerializeAsString())));
  message.mutable_site()->mutable_depth()->set_verdict(static_cast<shared::DepthVerdict>(3));
  EXPECT_FALSE(codec.decode(view(message.SerializeAsString())));
  message.mutable_site()->mutable_depth()->clear_verdict();
  message.mutable_site()->mutable_depth()->set_reason(
      static_cast<shared::DepthReason>(kDepthReasonCount));
  EXPECT_FALSE(codec.decode(view(message.SerializeAsString())));
}

struct Border {
  const char* name;
  std::function<void(WireTelegram&, double)> set;
  double limit;
};

ModelPayload& model_in(WireTelegram& wire) {
  return wire.telegram.port.payload.emplace<ModelPayload>();
}

std::vector<Border> borders() {
  return {
      {"position", [](auto& w, double x) { w.telegram.port.position = x; }, message::kLengthMax},
      {"velocity", [](auto& w, double x) { w.telegram.port.velocity = x; }, message::kSpeedMax},
      {"force", [](auto& w, double x) { w.telegram.port.force = x; }, message::kForceMax},
      {"x", [](auto& w, double x) { w.telegram.site.place.x = x; }, message::kLengthMax},
      {"y", [](auto& w, double x) { w.telegram.site.place.y = x; }, message::kLengthMax},
      {"depth", [](auto& w, double x) { w.telegram.site.depth.depth = x; }, message::kLengthMax},
      {"stddev",
       [](auto& w, double x) { w.telegram.site.depth.depth_stddev = x; },
       message::kLengthMax},
      {"low", [](auto& w, double x) { w.telegram.site.depth.depth_low = x; }, message::kLengthMax},
      {"high",
       [](auto& w, double x) { w.telegram.site.depth.depth_high = x; },
       message::kLengthMax},
      {"hash", [](auto& w, double x) { w.telegram.site.depth.hash = x; }, message::kForceMax},
      {"integral",
       [](auto& w, double x) {
         w.telegram.port.payload = WavePayload{x, 0};
       },
       message::kSumMax},
      {"energy",
       [](auto& w, double x) {
         w.telegram.port.payload = WavePayload{0, x};
       },
       message::kSumMax},
      {"energy in",
       [](auto& w, double x) { w.telegram.port.payload = TdpaPayload{x}; },
       message::kSumMax},
      {"c1", [](auto& w, double x) { model_in(w).c[0] = x; }, message::kForceMax},
      {"c3", [](auto& w, double x) { model_in(w).c[2] = x; }, message::kForceMax},
      {"surface", [](auto& w, double x) { model_in(w).surface = x; }, message::kLengthMax},
      {"depth_max", [](auto& w, double x) { model_in(w).depth_max = x; }, message::kLengthMax},
      {"residual", [](auto& w, double x) { model_in(w).residual = x; }, message::kForceMax},
      {"c4", [](auto& w, double x) { model_in(w).c[3] = x; }, message::kForceMax},
      {"c5", [](auto& w, double x) { model_in(w).c[4] = x; }, message::kForceMax},
      {"swing", [](auto& w, double x) { model_in(w).swing = x; }, message::kLengthMax},
      {"quadrature",
       [](auto& w, double x) { model_in(w).swing_quadrature = x; },
       message::kLengthMax},
      {"swing rate", [](auto& w, double x) { model_in(w).swing_rate = x; }, message::kSpeedMax},
      {"relaxing fast", [](auto& w, double x) { model_in(w).relaxing[0] = x; }, message::kForceMax},
      {"relaxing slow", [](auto& w, double x) { model_in(w).relaxing[1] = x; }, message::kForceMax},
      {"stiffness", [](auto& w, double x) { model_in(w).stiffness[11] = x; }, message::kForceMax},
      {"older",
       [](auto& w, double x) { w.older_count = 1, w.older[0].force = x; },
       message::kForceMax},
  };
}

TEST(CodecTest, EveryNumberHasItsLimitAndMustBeFinite) {
  WireCodec wire_codec;
  RawCodec raw;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Border& border : borders()) {
    for (Codec* codec : std::initializer_list<Codec*>{&wire_codec, &raw}) {
      WireTelegram wire;
      wire.telegram.site.depth.number = 1;
      for (const double good : {border.limit, -border.limit}) {
        border.set(wire, good);
        EXPECT_TRUE(codec->decode(encoded(*codec, wire))) << border.name;
      }
      for (const double bad : {std::nextafter(border.limit, kInfinity),
                               -1.01 * border.limit,
                               kInfinity,
                               std::nan("")}) {
        border.set(wire, bad);
        EXPECT_TRUE(encoded(*codec, wire).empty()) << border.name << " " << bad;
      }
    }
  }
}

TEST(WireCodecTest, DecodesNoNumberOutOfRange) {
  WireCodec codec;
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), 10.001F}) {
    auto message = plain_message();
    message.mutable_sample()->set_position_m(bad);
    EXPECT_FALSE(codec.decode(view(message.SerializeAsString()))) << bad;
  }
  auto message = plain_message();
  message.mutable_sample()->mutable_wave()->set_wave_energy_j(std::nan(""));
  EXPECT_FALSE(codec.decode(view(message.SerializeAsString())));
}

TEST(CodecTest, WholeNumbersHaveTheirLimits) {
  WireCodec codec;
  WireTelegram wire;
  wire.sent_at_ns = message::kSentAtMaxNs;
  EXPECT_FALSE(encoded(codec, wire).empty());
  wire.sent_at_ns = message::kSentAtMaxNs + 1;
  EXPECT_TRUE(encoded(codec, wire).empty());
  wire = {};
  wire.echo_ns = message::kSentAtMaxNs + 1;
  EXPECT_TRUE(encoded(codec, wire).empty());
  wire.echo_ns = 0;
  wire.hold_us = message::kHoldMaxUs;
  EXPECT_FALSE(encoded(codec, wire).empty());
  wire.hold_us = message::kHoldMaxUs + 1;
  EXPECT_TRUE(encoded(codec, wire).empty());
  wire.hold_us = 0;
  wire.newest_number = message::kNumberMax + 1;
  EXPECT_TRUE(encoded(codec, wire).empty());
  wire = {};
  wire.newest_number = 1;  // nothing was heard, so there is no number to name
  EXPECT_TRUE(encoded(codec, wire).empty());
  wire = {};
  wire.older_count = 3;
  EXPECT_TRUE(encoded(codec, wire).empty());
}

TEST(WireCodecTest, TelegramsHaveTheSizesOfTheWirePage) {
  WireCodec codec;
  WireTelegram wire;
  wire.sent_at_ns = message::kSentAtMaxNs;
  wire.echo_ns = message::kSentAtMaxNs;
  wire.hold_us = message::kHoldMaxUs;
  wire.newest_number = message::kNumberMax;
  wire.before_newest = 1;
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 4U);  // the link part, and two empty parts

  constexpr std::uint32_t kMost = ~0U;
  wire.telegram.port = {1, 1, 1, std::monostate{}};
  wire.older_count = 2;
  wire.older.fill(wire.telegram.port);
  wire.telegram.site = {SiteState::Stopped, kMost, {1, 0}, {}};
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 15U + 3 * 17U) << "a y of 0 takes no bytes";
  wire.telegram.site.place.y = 1;
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 20U + 3 * 17U);  // direct, surgeon to patient
  wire.telegram.site.depth = {
      kMost, DepthVerdict::Found, DepthReason::HashOutOfRange, 1, 1, 1, 1, 1, {1, 1}};
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 67U + 3 * 17U);  // direct, patient to surgeon
  ModelPayload model{kMost, {1, 1, 1, 1, 1}, 1, 1, 1, 1, 1, 1, {1, 1}};
  wire.telegram.port.payload = model;
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 67U + 90U + 2 * 17U);  // mmt, five numbers
  model.stiffness.fill(1);
  wire.telegram.port.payload = model;
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 67U + 163U + 2 * 17U);  // mmt, the largest
  wire.telegram.port.payload = TdpaPayload{1};
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 67U + 28U + 2 * 17U);
  wire.telegram.port.payload = WavePayload{1, 1};
  wire.older.fill(wire.telegram.port);
  EXPECT_EQ(encoded(codec, wire).size(), 37U + 67U + 3 * 37U);
}

TEST(WireCodecTest, WorksInAnotherThreadThanItsMaker) {
  const auto codec = std::make_unique<WireCodec>();
  bool same_there = false;
  std::thread{[&] {
    const auto received = codec->decode(encoded(*codec, some_telegram(3)));
    same_there = received && same(*received, rounded_as_on_wire(some_telegram(3)));
  }}.join();
  EXPECT_TRUE(same_there);
}

}  // namespace
}  // namespace palp::link
