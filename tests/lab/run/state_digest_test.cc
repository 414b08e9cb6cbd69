// Goal: the digest covers every number of every record. Method: records of all kinds are drawn, and
// each member byte of a copy that lies in a plain number is changed in turn.
#include "lab/run/state_digest.h"

#include <cstring>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/common/message/draw.h"

namespace palp::lab {
namespace {

std::uint64_t digest_of(const Record& record) {
  Digest digest;
  DigestRecorder recorder{digest, nullptr};
  recorder.record(record);
  return digest.value();
}

/// Calls `visit` with each number of a struct, wherever its list has it.
template <class Struct>
void each_member(Struct& of, const auto& visit) {
  message::each(message::fields<Struct>.items, [&]<class Item>(const Item& item) {
    auto& value = Item::of(of);
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (requires { item.choices; }) {
      std::visit(
          [&]<class Chosen>(Chosen& chosen) {
            if constexpr (message::Described<Chosen>) each_member(chosen, visit);
          },
          value);
    } else if constexpr (message::kIsOptional<Value>) {
      if (value) each_member(*value, visit);
    } else if constexpr (message::Described<Value>) {
      each_member(value, visit);
    } else {
      visit(value, item);
    }
  });
}

template <class Struct>
void expect_each_member_counts(std::uint64_t seed) {
  auto one = message::drawn<message::Form::Log, Struct>(seed);
  const std::uint64_t before = digest_of(one);
  each_member(one, [&](auto& value, const auto& item) {
    using Value = std::remove_cvref_t<decltype(value)>;
    const Value old = value;
    if constexpr (std::is_same_v<Value, double>) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      bits ^= 1;
      std::memcpy(&value, &bits, sizeof bits);
    } else if constexpr (std::is_same_v<Value, bool>) {
      value = !value;
    } else {
      value = message::from_number<Value>(
          static_cast<message::NumberOf<Value>>(message::number_of(value) ^ 1));
    }
    EXPECT_NE(digest_of(one), before) << item.name.surgeon;
    value = old;
  });
  EXPECT_EQ(digest_of(one), before);
}

TEST(StateDigestTest, EachNumberOfEachRecordCounts) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    expect_each_member_counts<SiteTick>(seed);
    expect_each_member_counts<Arrived>(seed);
    expect_each_member_counts<LinkStatus>(seed);
    expect_each_member_counts<Note>(seed);
    expect_each_member_counts<Transition>(seed);
    expect_each_member_counts<DepthEstimate>(seed);
    expect_each_member_counts<DepthArrived>(seed);
    expect_each_member_counts<MapEstimate>(seed);
    expect_each_member_counts<MapArrived>(seed);
    expect_each_member_counts<MapCell>(seed);
  }
}

TEST(StateDigestTest, WhetherThereIsAClockAndWhichPayloadCount) {
  LinkStatus none;
  LinkStatus clocked;
  clocked.health.peer_clock.emplace();
  EXPECT_NE(digest_of(none), digest_of(clocked));
  SiteTick plain;
  SiteTick tdpa;
  tdpa.sent.payload = TdpaPayload{};
  EXPECT_NE(digest_of(plain), digest_of(tdpa));
}

}  // namespace
}  // namespace palp::lab
