#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "common/link/codec_wire.h"
#include "common/link/link.h"
#include "tests/common/link/test_pipe.h"

/// Two Links over a TestPipe, ticked together in virtual time.
namespace palp::link {

/// One end, what it says and what it was handed.
struct Side {
  Link link;
  Telegram telegram;
  std::vector<Incoming> samples;  ///< all, in the order they came
  Arrivals last;                  ///< of the last tick; its span is gone
  bool sending{true};

  Side(const LinkConfig& config, std::unique_ptr<Codec> codec) : link{config, std::move(codec)} {}
};

class Couple {
 public:
  explicit Couple(const LinkConfig& config = {}, bool raw = false)
      : surgeon{config, make_codec(raw)},
        patient{config, make_codec(raw)},
        period_{config.period} {}

  TestPipe pipe;
  Side surgeon;
  Side patient;
  TimePoint now{};

  static std::unique_ptr<Codec> make_codec(bool raw) {
    if (raw) return std::make_unique<RawCodec>();
    return std::make_unique<WireCodec>();
  }

  /// As two Sessions would: ids of the surgeon are even.
  void connect(std::uint64_t session_id = 1) {
    const auto id = static_cast<std::uint32_t>(2 * session_id);
    (void)surgeon.link.adopt(link_update(pipe.surgeon_end(), id + 1, id, session_id), now);
    (void)patient.link.adopt(link_update(pipe.patient_end(), id, id + 1, session_id), now);
  }

  static LinkUpdate link_update(std::unique_ptr<Transport> transport,
                                std::uint32_t send,
                                std::uint32_t receive,
                                std::uint64_t session_id) {
    return {.transport = std::move(transport),
            .protection = std::make_unique<PlainProtection>(),
            .send_connection = send,
            .receive_connection = receive,
            .session_id = session_id};
  }

  void tick() {
    for (Side* side : {&surgeon, &patient}) {
      side->last = side->link.receive(now);
      side->samples.insert(
          side->samples.end(), side->last.samples.begin(), side->last.samples.end());
    }
    if (before_send) before_send();
    for (Side* side : {&surgeon, &patient}) {
      if (side->sending) side->link.send(side->telegram, now);
    }
    now += period_;
  }

  void run(Duration span) {
    for (const TimePoint end = now + span; now < end;) tick();
  }

  /// Health as it was at the end of the last tick.
  [[nodiscard]] LinkHealth surgeon_health() const { return surgeon.link.health(now - period_); }
  [[nodiscard]] LinkHealth patient_health() const { return patient.link.health(now - period_); }

  std::function<void()> before_send;

 private:
  Duration period_;
};

}  // namespace palp::link
