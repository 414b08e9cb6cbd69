#include "surgeon_site/devices/hid_master.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "surgeon_site/devices/firmware/paddle/paddle_report.h"
#include "surgeon_site/devices/paddle.h"

namespace palp::surgeon {
namespace {

/// A paddle that always answers, and keeps the newest force.
class FreePaddle final : public io::ReportPort {
 public:
  std::atomic<int> force_un{};
  std::atomic<bool> lamp{};
  std::atomic<bool> plugged{true};

  io::PortFault open() override { return plugged ? io::PortFault::None : io::PortFault::NotOpen; }
  void close() override {}
  io::PortFault read(std::span<std::uint8_t> report, std::size_t& length, Duration) override {
    length = 0;
    if (!plugged) return io::PortFault::Lost;
    if (std::exchange(told_, !told_)) return io::PortFault::None;
    palp_paddle::State state{};
    state.flags = palp_paddle::kStateCalibrated | palp_paddle::kStatePedalHeld;
    state.position_nm = -4'000'000;
    state.sequence = ++sequence_;
    palp_paddle::pack(state, report.data());
    length = palp_paddle::kReportBytes;
    return io::PortFault::None;
  }
  io::PortFault write(std::span<const std::uint8_t> report) override {
    palp_paddle::Command command{};
    if (palp_paddle::unpack(report.data() + 1, report.size() - 1, command)) {
      force_un = command.force_un;
      lamp = (command.flags & palp_paddle::kCommandLamp) != 0;
    }
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
  bool told_{};
  std::uint16_t sequence_{};
};

/// Looks until `done`, 20 s at most.
template <class Done>
bool wait_for(const Done& done) {
  const io::SteadyClock clock;
  const TimePoint end = clock.now() + std::chrono::seconds{20};
  while (!done()) {
    if (clock.now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

struct Bench {
  Bench() {
    auto made = std::make_unique<FreePaddle>();
    raw = made.get();
    MasterInstallation built_in;
    built_in.position_unit = Paddle::kPositionUnit;
    built_in.force_unit = Paddle::kForceUnit;
    built_in.force_max = 3;
    thread = std::make_unique<MasterThread>(
        "master", std::make_unique<Paddle>(), built_in, std::move(made), 0);
    hand = std::make_unique<HidMaster>(*thread, HandFacts{.axes = 1});
  }
  FreePaddle* raw{};
  io::SteadyClock clock;
  std::unique_ptr<MasterThread> thread;
  std::unique_ptr<HidMaster> hand;
};

TEST(HidMasterTest, ReadsAndPushesWithAThreadOfItsOwn) {
  Bench bench;
  EXPECT_TRUE(bench.hand->read(bench.clock.now()).faulted ||
              bench.thread->status().state == MasterState::Ready);
  ASSERT_TRUE(wait_for([&] { return !bench.hand->read(bench.clock.now()).faulted; }));
  ASSERT_TRUE(wait_for([&] {
    const HandState state = bench.hand->read(bench.clock.now());
    bench.hand->apply(1.25);
    OperatorView view;
    view.state = SiteState::Engaged;
    bench.hand->show(view);
    return state.position == -4e-3 && state.pedal_held && bench.raw->force_un == 1'250'000 &&
           bench.raw->lamp;
  }));
  EXPECT_TRUE(wait_for([&] { return bench.raw->force_un == 0; })) << "the site said nothing more";
  EXPECT_EQ(bench.hand->hand_facts().axes, 1U);
  EXPECT_EQ(bench.thread->name(), "master");
}

TEST(HidMasterTest, AnOldLookIsAFaultWhateverItsThreadSays) {
  Bench bench;
  ASSERT_TRUE(wait_for([&] { return !bench.hand->read(bench.clock.now()).faulted; }));
  const HandState late = bench.hand->read(bench.clock.now() + std::chrono::minutes{1});
  EXPECT_TRUE(late.faulted);
  EXPECT_FALSE(late.pedal_held);
}

TEST(HidMasterTest, UnpluggedItIsFaulted) {
  Bench bench;
  ASSERT_TRUE(wait_for([&] { return !bench.hand->read(bench.clock.now()).faulted; }));
  bench.raw->plugged = false;
  ASSERT_TRUE(wait_for([&] { return bench.thread->status().state == MasterState::Absent; }));
  EXPECT_TRUE(bench.hand->read(bench.clock.now()).faulted);
  bench.thread->restart();
}

}  // namespace
}  // namespace palp::surgeon
