// Goal: a tick of the patient's node does nothing that a real-time thread must not do.
// Method: RealtimeGuard around every tick from the first one on, with the real codec, a hand that
// engages, presses and lets go, a gap, datagrams that are no telegrams, and a full estimator queue.
#include <algorithm>
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "common/link/codec_wire.h"
#include "patient_site/patient_node.h"
#include "patient_site/simulated_phantom.h"
#include "tests/support/realtime_guard.h"

namespace palp::patient {
namespace {

using test::RealtimeGuard;

/// Datagrams on their way, in fixed memory.
struct Lane {
  struct Slot {
    std::size_t size{};
    std::array<std::byte, link::kDatagramSizeMax> bytes{};
  };
  std::array<Slot, 16> slots{};
  std::size_t first{};
  std::size_t count{};

  bool push(std::span<const std::byte> datagram) noexcept {
    if (count == slots.size()) return false;
    Slot& slot = slots[(first + count++) % slots.size()];
    slot.size = datagram.size();
    std::copy(datagram.begin(), datagram.end(), slot.bytes.begin());
    return true;
  }
};

class LaneEnd final : public link::Transport {
 public:
  LaneEnd(Lane& out, Lane& in) : out_{out}, in_{in} {}
  bool send(std::span<const std::byte> datagram, TimePoint /*now*/) noexcept override {
    return out_.push(datagram);
  }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    if (in_.count == 0) return std::nullopt;
    const Lane::Slot& slot = in_.slots[in_.first];
    in_.first = (in_.first + 1) % in_.slots.size();
    --in_.count;
    std::copy_n(slot.bytes.begin(), slot.size, buffer.begin());
    return link::Datagram{slot.size, now};
  }

 private:
  Lane& out_;
  Lane& in_;
};

class CountingRecorder final : public record::Recorder {
 public:
  bool record(const Record& /*record*/) noexcept override {
    ++count_;
    return true;
  }

 private:
  std::uint64_t count_{};
};

TEST(PatientRealtimeTest, ATickNeitherAllocatesNorWaits) {
  const Phantom phantom = *make_phantom("paper-5mm");
  SimulatedPhantom site{phantom, {}};
  coupling::PatientCoupling law{*coupling::make_patient_coupling({})};
  Lane up;
  Lane down;
  link::Link surgeon{{}, std::make_unique<link::WireCodec>()};
  link::Link patient{{}, std::make_unique<link::WireCodec>()};
  CountingRecorder recorder;
  SpscQueue<ContactSample> contact{64};
  Mailbox<Findings> found;
  Mailbox<MapCells> cells;
  TimePoint now{};
  const auto hand_over = [](Lane& out, Lane& in, std::uint32_t send, std::uint32_t receive) {
    return link::LinkUpdate{.transport = std::make_unique<LaneEnd>(out, in),
                            .protection = std::make_unique<link::PlainProtection>(),
                            .send_connection = send,
                            .receive_connection = receive,
                            .session_id = 1};
  };
  (void)surgeon.adopt(hand_over(up, down, 3, 2), now);
  (void)patient.adopt(hand_over(down, up, 2, 3), now);
  PatientNode node{{}, {site, site, law, patient, recorder, contact, found, cells}};

  Telegram say;
  RealtimeGuard guard;
  for (int i = 0; i < 4000; ++i) {
    now += std::chrono::milliseconds{1};
    {
      const RealtimeGuard::Pause pause;
      say.site.state = i < 300 ? SiteState::Clutched : SiteState::Engaged;
      say.site.epoch = i < 300 ? 0 : 1;
      say.port.position = std::min(-10e-3 + std::max(i - 300, 0) * 20e-6, 3e-3);
      (void)surgeon.receive(now);
      if (i < 2000 || i > 2800) surgeon.send(say, now);
      if (i % 7 == 0) {
        std::array<std::byte, 40> forged{};
        forged.fill(static_cast<std::byte>(i));
        (void)up.push(forged);
      }
    }
    node.tick(now);
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
  const PatientStatus status = node.status().get();
  EXPECT_GT(status.contact_samples_lost, 0U) << "the queue was full";
  EXPECT_GT(status.link.accepted, 2500U);
  EXPECT_TRUE(status.surface_known) << "there was contact";
  EXPECT_EQ(status.state, SiteState::Clutched) << "lost, retracted, parked, ready again";
}

}  // namespace
}  // namespace palp::patient
