// What bytes of messages cost: message_bench [ROUNDS]
// A telegram written and read, and each kind of record written for the session file: nanoseconds
// each, the least of ten runs.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <time.h>

#include "common/link/codec_wire.h"
#include "common/record/session_encoder.h"

namespace palp::bench {

double now_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

void report(const char* name, int rounds, const auto& work) {
  double least = 1e18;
  for (int run = 0; run < 10; ++run) {
    const double begin = now_ns();
    for (int i = 0; i < rounds; ++i) work(i);
    least = std::min(least, (now_ns() - begin) / rounds);
  }
  std::printf("%-24s %8.1f ns\n", name, least);
}

}  // namespace palp::bench

namespace palp::link {

void telegrams(int rounds) {
  WireTelegram telegram;
  telegram.sent_at_ns = 123'456'789'012;
  telegram.echo_ns = 123'456'000'000;
  telegram.hold_us = 500;
  telegram.newest_number = 100'000;
  telegram.before_newest = ~0U;
  telegram.telegram.site = {SiteState::Engaged, 3, {.x = 0.01, .y = 0}, {}};
  telegram.telegram.site.depth = {.number = 2, .depth = 0.01, .hash = 0.07};
  telegram.older_count = 2;
  telegram.older.fill({.position = 0.001, .velocity = 0.02, .force = 0.3, .payload = {}});
  ModelPayload model;
  model.version = 5;
  model.c = {1, 2, 3, 4, 5};
  model.surface = model.depth_max = model.residual = 1e-3;
  telegram.telegram.port = {.position = 1e-3, .velocity = 0.1, .force = 0.2, .payload = model};
  WireCodec codec;
  std::array<std::byte, message::kTelegramSizeMax> bytes{};
  std::size_t size = 0;
  bench::report("telegram written", rounds, [&](int i) {
    telegram.hold_us = static_cast<std::uint32_t>(i & 1023);
    size = codec.encode(telegram, bytes);
  });
  std::uint64_t sum = 0;
  bench::report("telegram read", rounds, [&](int) {
    sum += codec.decode(std::span{bytes}.first(size))->newest_number;
  });
  std::printf("%-24s %8zu bytes\n", "telegram", sum == 0 ? 0 : size);
}

}  // namespace palp::link

namespace palp::record {

void records(int rounds) {
  SiteTick tick;
  tick.state = SiteState::Engaged;
  tick.epoch = 3;
  tick.position = 1e-3;
  tick.velocity = tick.force = tick.command = 0.1;
  tick.round_trip = Duration{20'000'000};
  tick.sent = {.position = 1e-3, .velocity = 0.5, .force = 0.2, .payload = {}};
  Arrived arrived;
  arrived.incoming.sample = tick.sent;
  ModelPayload model;
  model.version = 5;
  model.c = {1, 2, 3, 4, 5};
  model.surface = model.depth_max = model.residual = 1e-3;
  arrived.incoming.sample.payload = model;
  arrived.incoming.number = 100'000;
  LinkStatus status;
  status.health.state = LinkState::Live;
  status.health.sent = status.health.accepted = 100'000;
  status.health.peer_clock.emplace();
  DepthEstimate estimate;
  estimate.number = 1;
  estimate.depth = estimate.hash = 0.01;
  const std::array<std::pair<const char*, Record>, 5> all{
      {{"tick", tick},
       {"arrived with a model", arrived},
       {"link status", status},
       {"note", Note{.at = {}, .code = 33, .detail = 1.5}},
       {"depth estimate", estimate}}};
  SessionEncoder encoder{link::Role::Patient};
  std::vector<std::byte> room(1024);
  for (const auto& [name, record] : all) {
    bench::report(name, rounds, [&encoder, &room, &one = record](int i) {
      const auto prepared = encoder.prepare(one, static_cast<std::uint64_t>(i));
      if (prepared) encoder.store(room.data());
    });
  }
}

}  // namespace palp::record

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 100'000;
  if (rounds <= 0) {
    std::fprintf(stderr, "message_bench: ROUNDS must be a whole number above 0\n");
    return 2;
  }
  palp::link::telegrams(rounds);
  palp::record::records(rounds);
  return 0;
}
