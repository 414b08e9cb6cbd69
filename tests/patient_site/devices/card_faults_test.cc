// Each fault of each force card: the state it leads to and the time that takes. The rows stand in
// docs/hardware.md, and are measured here in virtual time.
#include <cmath>
#include <functional>

#include "tests/patient_site/devices/card_bench.h"
#include "tests/support/fault_rows.h"
#include "tests/support/random_runs.h"

namespace palp::patient {
namespace {

using fake_hid::Bytes;
using std::chrono::milliseconds;

class CardFaultBench : public CardBench {
 public:
  explicit CardFaultBench(CardKind kind) : CardBench{kind}, kind_{kind} {}
  void TestBody() override {}

  [[nodiscard]] int middle() const { return kind_ == CardKind::Usb1608 ? 0x8000 : 0x0020; }
  [[nodiscard]] int top() const { return kind_ == CardKind::Usb1608 ? 0xFFF0 : 0x7FF0; }
  [[nodiscard]] int noise() const { return kind_ == CardKind::Usb1608 ? 2 : 16; }
  /// A millisecond, with a packet or without.
  CardReading pass(bool packets, int raw, int wobble) {
    if (packets) packet(raw, wobble);
    return step();
  }
  void plug(bool in) {
    for (auto* const one : raw_) one->there = in;
  }
  void spoil(std::size_t length) { raw_[1]->input.push_back(Bytes(length, 1)); }
  TestClock& clock() { return clock_; }
  DeviceAsks& asks() { return asks_; }
  std::uint16_t& index() { return index_; }
  std::vector<fake_hid::Device*>& raw() { return raw_; }

 private:
  CardKind kind_;
};

struct CardFault {
  std::string name;
  bool packets;
  int raw;  ///< 0: quiet air, 1: the end of the range
  bool wobbles;
  bool plugged;
  std::string state;
  bool only_wide{};  ///< of 16 bits
};

std::vector<CardFault> card_faults() {
  return {{"no packets", false, 0, true, true, "absent: it fell silent"},
          {"unplugged", false, 0, true, false, "absent: connection lost"},
          {"short and long packets", false, 2, true, true, "absent: it fell silent"},
          {"force saturated", true, 1, true, true, "ready, saturated: "},
          {"force stuck", true, 0, false, true, "fault: the reading is stuck", true}};
}

std::string card_state(const CardReading& card) {
  return std::string{to_string(card.state)} + (card.saturated ? ", saturated" : "") + ": " +
         std::string{card.why};
}

class CardFaultTest : public testing::TestWithParam<CardKind> {};

TEST_P(CardFaultTest, EachEndsWhereTheTableSaysInTime) {
  int rows = 0;
  for (const CardFault& fault : card_faults()) {
    if (fault.only_wide && GetParam() != CardKind::Usb1608) continue;
    CardFaultBench card{GetParam()};
    CardReading reading;
    for (int i = 0; i < 60; ++i) reading = card.pass(true, card.middle(), card.noise());
    ASSERT_EQ(reading.state, CardState::Ready) << reading.why;
    card.plug(fault.plugged);
    int after = 0;
    for (; after < 1000 && card_state(reading) != fault.state; ++after) {
      if (fault.raw == 2) card.spoil(after % 2 == 0 ? 7 : 80);
      reading = card.pass(fault.packets,
                          fault.raw == 1 ? card.top() : card.middle(),
                          fault.wobbles ? card.noise() : 0);
      ASSERT_NEAR(reading.force, 0, fault.raw == 1 ? 60 : 0.2) << fault.name;
    }
    ASSERT_EQ(card_state(reading), fault.state) << fault.name;
    const std::string row = fault_row(
        std::string{card_model(GetParam()).name}, fault.name, in_words(fault.state), after, "-");
    EXPECT_TRUE(is_documented(row)) << row;
    ++rows;
  }
  EXPECT_EQ(rows, documented_rows(std::string{card_model(GetParam()).name}));
}

TEST_P(CardFaultTest, NoSequenceOfThemGivesAForceThatIsNoNumber) {
  CardFaultBench card{GetParam()};
  for (std::uint64_t turn = 0; turn < 1000; ++turn) {
    const RandomStream stream = random_run(18, turn);
    std::uint64_t index = 0;
    const auto draw = [&](std::uint64_t count) { return stream.bits(index++) % count; };
    for (int i = 0; i < 8; ++i) {
      auto* const one = card.raw()[draw(card.raw().size())];
      switch (draw(7)) {
        case 0:
          one->there = !one->there;
          break;
        case 1:
          one->input.push_back(Bytes(draw(70), static_cast<std::uint8_t>(draw(256))));
          break;
        case 2:
          card.index() = static_cast<std::uint16_t>(draw(65'536));
          break;
        case 3:
          card.clock().at += milliseconds{static_cast<int>(draw(600))};
          break;
        case 4:
          ++card.asks().restarts;
          break;
        case 5:
          ++card.asks().tares;
          break;
        default:
          break;
      }
      const CardReading reading = card.pass(true, static_cast<int>(draw(65'000)) + 100, 2);
      ASSERT_TRUE(std::isfinite(reading.force));
      ASSERT_LE(std::abs(reading.volts), 20.1);
    }
    for (auto* const one : card.raw()) {
      one->there = true;
      one->input.clear();
    }
    card.raw()[0]->written.clear();
  }
}

INSTANTIATE_TEST_SUITE_P(Cards,
                         CardFaultTest,
                         testing::Values(CardKind::Usb1608, CardKind::Usb1208),
                         [](const auto& one) {
                           return one.param == CardKind::Usb1608 ? "usb1608fs" : "usb1208fs";
                         });

}  // namespace
}  // namespace palp::patient
