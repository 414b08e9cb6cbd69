#include "patient_site/devices/card_thread.h"

#include <bit>
#include <thread>

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

/// One interface of a card: the first answers for its memory, the second gives all packets.
class FreeCard final : public io::ReportPort {
 public:
  explicit FreeCard(std::size_t number) : number_{number} {}
  io::PortFault open() override { return io::PortFault::None; }
  void close() override {}
  io::PortFault read(std::span<std::uint8_t> report, std::size_t& length, Duration) override {
    length = 0;
    if (number_ == 0 && asked_) answer(report, length);
    if (number_ == 1 && (told_ = !told_)) packet(report, length);
    return io::PortFault::None;
  }
  io::PortFault write(std::span<const std::uint8_t> report) override {
    asked_ = report[0] == 0x30;
    if (asked_) address_ = static_cast<unsigned>(report[1]) + 256U * report[2];
    return io::PortFault::None;
  }
  io::PortFault set_feature(std::span<const std::uint8_t>) override {
    return io::PortFault::Refused;
  }
  io::PortFault get_feature(std::span<std::uint8_t>, std::size_t& length) override {
    length = 0;
    return io::PortFault::Refused;
  }

 private:
  void put(std::span<std::uint8_t> at, std::uint32_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      at[i] = static_cast<std::uint8_t>((value >> (8U * i)) & 0xFFU);
    }
  }
  void answer(std::span<std::uint8_t> report, std::size_t& length) {
    asked_ = false;
    report[0] = 0x30;
    length = 5;
    const float volts = address_ == 0x80 ? 5.0F : address_ == 0xA0 ? -5.0F : 0.0F;
    std::uint32_t bits = std::bit_cast<std::uint32_t>(volts);
    if (address_ == 0xB0) bits = 0xC0008000U;
    if (address_ == 0x130) bits = 0x4000U;
    put(report.subspan(1), bits, 4);
  }
  void packet(std::span<std::uint8_t> report, std::size_t& length) {
    length = 64;
    for (std::size_t i = 0; i < 31; ++i) {
      put(report.subspan(2 * i), 0x8000U + (index_ + static_cast<std::uint32_t>(i)) % 3U, 2);
    }
    put(report.subspan(62), index_++ & 0xFFFFU, 2);
  }
  std::size_t number_;
  bool asked_{};
  bool told_{};
  unsigned address_{};
  std::uint32_t index_{};
};

TEST(CardThreadTest, TaresAndFeelsWithAThreadOfItsOwn) {
  CardInstallation built_in;
  built_in.newtons_per_volt = 5;
  built_in.load.tare_time = std::chrono::milliseconds{10};
  built_in.silence = std::chrono::seconds{30};  // of no account here
  CardThread::Ports ports;
  for (std::size_t i = 0; i <= 6; ++i) ports.push_back(std::make_unique<FreeCard>(i));
  CardThread card{built_in, std::move(ports), 0};
  CardForce force{card, ForceSensorFacts{}};
  const io::SteadyClock clock;
  const TimePoint end = clock.now() + std::chrono::seconds{20};
  std::optional<ForceSample> sample;
  while (!sample && clock.now() < end) {
    sample = force.sample(clock.now());
    std::this_thread::yield();
  }
  ASSERT_TRUE(sample) << card.status().why;
  EXPECT_NEAR(sample->force, 0, 0.01);
  EXPECT_FALSE(sample->saturated);
  card.requests().restart();
}

}  // namespace
}  // namespace palp::patient
