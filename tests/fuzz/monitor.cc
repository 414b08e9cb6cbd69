// Input: what clients of the monitor say, a script: who, how long after the last, whether text or
// bytes, a length, then so many bytes.
#include <string>

#include "common/core/check.h"
#include "monitor/desk.h"
#include "tests/fuzz/fuzz.h"

namespace palp::monitor {
namespace {

using fuzz::ByteSource;

struct Rig {
  SpscQueue<Request> requests{64};
  Mailbox<std::uint32_t> stops;
  Mailbox<PointerReport> pointer;
  Desk desk{{.site = link::Role::Surgeon, .program = "palp-surgeon", .run = "r"},
            {.requests = &requests, .stops = &stops, .pointer = &pointer}};
};

/// What it was sent is one frame of the protocol after the other.
void take_all(Desk& desk, std::uint32_t client) {
  Outbox& box = desk.outbox(client);
  while (!box.empty()) {
    const Frame& frame = box.begin_first();
    PALP_CHECK(!frame.body.empty(), "no frame is empty");
    PALP_CHECK(frame.text == (frame.body.front() == '{'), "a text is an object, bytes are not");
    box.pop();
  }
}

void run(ByteSource input) {
  Rig rig;
  TimePoint now{std::chrono::seconds{1}};
  const std::uint32_t looks = rig.desk.join(Right::View, now);
  const std::uint32_t steers = rig.desk.join(Right::Control, now);
  rig.desk.heard_pong(steers, std::chrono::milliseconds{1}, now);
  while (!input.empty()) {
    const std::uint32_t who = input.below(2) == 0 ? looks : steers;
    now += std::chrono::milliseconds{10} + std::chrono::milliseconds{input.below(256)};
    const bool text = input.below(2) == 0;
    std::string said;
    for (const std::byte one : input.take_bytes(input.take<std::uint16_t>() % 1024U)) {
      said += static_cast<char>(one);
    }
    const bool stays =
        text ? rig.desk.hear_text(who, said, now) : rig.desk.hear_bytes(who, said, now);
    PALP_CHECK(stays, "who keeps within its budget stays");
    rig.desk.heard_pong(steers, std::chrono::milliseconds{1}, now);
    LiveStatus status;
    status.stamp = static_cast<std::uint64_t>(now.time_since_epoch().count());
    rig.desk.publish(status);
    take_all(rig.desk, looks);
    take_all(rig.desk, steers);
    PALP_CHECK(rig.desk.pilot() != looks, "who only looks is no pilot");
    const PointerReport& report = rig.pointer.get();
    PALP_CHECK(!report.held || rig.desk.pilot() == steers, "nobody else holds the hand");
    PALP_CHECK(report.into >= -1 && report.into <= 1, "a finger is not drawn off the screen");
    for (Request request; rig.requests.try_dequeue(request);) {
      PALP_CHECK(request.client == steers, "who only looks asks for nothing");
    }
  }
}

}  // namespace
}  // namespace palp::monitor

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palp::monitor::run(palp::fuzz::ByteSource{palp::fuzz::as_bytes(data, size)});
  return 0;
}
