#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "common/link/aead_protection.h"
#include "common/link/codec_wire.h"
#include "common/link/link.h"
#include "netem/model/pipe.h"
#include "tests/common/link/some_keys.h"

/// Two Links under keys over the emulated network, each on a clock of its own, in virtual time.
namespace palp::link {

/// A site's line of time as seen from the true one.
struct SiteClock {
  Duration offset{};
  double skew{};  ///< [s/s]

  [[nodiscard]] TimePoint at(TimePoint truth) const {
    const Duration passed = truth.time_since_epoch();
    return truth + offset + from_seconds(skew * seconds(passed));
  }
};

/// The end of a pipe for a site with another clock than the pipe's.
class ClockedTransport final : public Transport {
 public:
  ClockedTransport(std::unique_ptr<Transport> next, SiteClock clock, const TimePoint& truth)
      : next_{std::move(next)}, clock_{clock}, truth_{truth} {}
  bool send(std::span<const std::byte> datagram, TimePoint) noexcept override {
    return next_->send(datagram, truth_);
  }
  std::optional<Datagram> receive(std::span<std::byte, kDatagramSizeMax> buffer,
                                  TimePoint) noexcept override {
    auto received = next_->receive(buffer, truth_);
    if (received) received->arrived_at = clock_.at(received->arrived_at);
    return received;
  }

 private:
  std::unique_ptr<Transport> next_;
  SiteClock clock_;
  const TimePoint& truth_;
};

class NetworkCouple {
 public:
  struct Side {
    Link link{{}, std::make_unique<WireCodec>()};
    SiteClock clock;
    Telegram telegram;
    LinkHealth health;  ///< of the last tick
    std::function<void(const Arrivals&)> look;
    bool sending{true};
  };

  NetworkCouple(const netem::PathPlan& up,
                const netem::PathPlan& down,
                std::uint64_t seed,
                SiteClock patient_clock = {})
      : pipe_{up, down, seed, kInFlightMax} {
    patient.clock = patient_clock;
    connect(1);
  }

  /// A new session, with keys of its own.
  void connect(std::uint64_t id) {
    const auto low = static_cast<std::uint32_t>(2 * id);
    adopt(surgeon, pipe_.surgeon_end(), Role::Surgeon, {low + 1, low}, id);
    adopt(patient, pipe_.patient_end(), Role::Patient, {low, low + 1}, id);
  }

  /// A millisecond; the patient ticks 370 us after the surgeon.
  void tick() {
    work(surgeon);
    now += std::chrono::microseconds{370};
    work(patient);
    now += std::chrono::microseconds{630};
  }
  void run(Duration span) {
    for (const TimePoint end = now + span; now < end;) tick();
  }

  Side surgeon;
  Side patient;
  TimePoint now{};  ///< the true time

 private:
  static constexpr std::size_t kInFlightMax = 8192;
  struct Connections {
    std::uint32_t send{};
    std::uint32_t receive{};
  };

  void adopt(Side& side,
             std::unique_ptr<Transport> end,
             Role role,
             Connections connections,
             std::uint64_t id) const {
    (void)side.link.adopt(
        {.transport = std::make_unique<ClockedTransport>(std::move(end), side.clock, now),
         .protection = std::make_unique<AeadProtection>(some_keys(id, role).data),
         .send_connection = connections.send,
         .receive_connection = connections.receive,
         .session_id = id},
        side.clock.at(now));
  }

  void work(Side& side) const {
    const TimePoint here = side.clock.at(now);
    const Arrivals arrivals = side.link.receive(here);
    side.health = side.link.health(here);
    if (side.look) side.look(arrivals);
    if (side.sending) side.link.send(side.telegram, here);
  }

  netem::Pipe pipe_;
};

}  // namespace palp::link
