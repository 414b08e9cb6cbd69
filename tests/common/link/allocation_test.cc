#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <thread>

#include <gtest/gtest.h>

#include "common/link/aead_protection.h"
#include "common/link/codec_wire.h"
#include "common/link/link.h"
#include "proto/link.pb.h"
#include "tests/common/link/some_keys.h"
#include "tests/common/link/some_telegram.h"

// Counts every heap allocation of C++ in this binary, shared libraries included.
namespace {
std::atomic<std::uint64_t> allocations{0};

void* counted(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc{};
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace palp::link {
namespace {

using std::chrono_literals::operator""ms;

std::uint64_t allocations_of(const auto& work) {
  const std::uint64_t before = allocations.load();
  work();
  return allocations.load() - before;
}

/// Round trips, flipped bits and truncations.
void exercise(Codec& codec) {
  std::array<std::byte, kTelegramSizeMax> bytes{};
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const std::size_t size = codec.encode(some_telegram(seed), bytes);
    (void)codec.decode(std::span{bytes}.first(size));
    const std::uint64_t bit = random_bits(seed, 9, 0) % (8 * size);
    bytes[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    (void)codec.decode(std::span{bytes}.first(size));
    (void)codec.decode(std::span{bytes}.first(bit % size));
  }
}

TEST(AllocationTest, TheCounterSeesTheParserAllocate) {
  std::array<std::byte, kTelegramSizeMax> bytes{};
  WireCodec codec;
  const std::size_t size = codec.encode(some_telegram(1), bytes);
  EXPECT_GT(allocations_of([&] {
              wire::Telegram message;
              (void)message.ParseFromArray(bytes.data(), static_cast<int>(size));
            }),
            0U);
}

TEST(AllocationTest, CodecsAllocateNothing) {
  WireCodec wire_codec;
  RawCodec raw;
  EXPECT_EQ(allocations_of([&] { exercise(wire_codec); }), 0U);
  EXPECT_EQ(allocations_of([&] { exercise(raw); }), 0U);
}

TEST(AllocationTest, CodecsAllocateNothingInAnotherThread) {
  WireCodec wire_codec;
  std::uint64_t there = 1;
  std::thread{[&] { there = allocations_of([&] { exercise(wire_codec); }); }}.join();
  EXPECT_EQ(there, 0U);
}

TEST(AllocationTest, HostileBytesMakeNobodyAllocate) {
  WireCodec codec;
  // sample { wave {} tdpa {} wave {} tdpa {} ... }, and unknown fields all over.
  std::string switching{"\x32\x00\x3A\xFC\x07", 5};
  while (switching.size() < 1024) switching += std::string{"\x22\x00\x2A\x00", 4};
  switching.resize(5 + 1020);
  std::string unknown{"\x32\x00\x3A\x00", 4};
  while (unknown.size() < 1024) unknown += std::string{"\x7A\x02xx", 4};
  switching.resize(1024);
  EXPECT_EQ(allocations_of([&] {
              (void)codec.decode(std::as_bytes(std::span{switching}));
              (void)codec.decode(std::as_bytes(std::span{unknown}));
            }),
            0U);
}

/// A transport that repeats, spoils and forges within fixed memory.
class EchoingTransport final : public Transport {
 public:
  bool send(std::span<const std::byte> datagram, TimePoint) noexcept override {
    std::copy(datagram.begin(), datagram.end(), last_.begin());
    size_ = datagram.size();
    turn_ = 0;
    return true;
  }
  std::optional<Datagram> receive(std::span<std::byte, kDatagramSizeMax> buffer,
                                  TimePoint now) noexcept override {
    if (size_ == 0 || turn_ > 4) return std::nullopt;
    std::copy_n(last_.begin(), size_, buffer.begin());
    std::size_t size = size_;
    if (turn_ == 1) size -= 3;
    if (turn_ == 2) buffer[5] ^= std::byte{1};
    if (turn_ == 3) buffer[kHeaderSize + 4] ^= std::byte{0xFF};
    ++turn_;
    return Datagram{size, now};
  }

 private:
  std::array<std::byte, kDatagramSizeMax> last_{};
  std::size_t size_{};
  int turn_{};
};

TEST(AllocationTest, LinkAllocatesNothingUnderGoodAndBadTraffic) {
  Link link{LinkConfig{}, std::make_unique<WireCodec>()};
  LinkUpdate link_update{.transport = std::make_unique<EchoingTransport>(),
                         .protection = std::make_unique<PlainProtection>(),
                         .send_connection = 5,
                         .receive_connection = 5,
                         .session_id = 1};
  LinkUpdate next{.transport = std::make_unique<EchoingTransport>(),
                  .protection = std::make_unique<PlainProtection>(),
                  .send_connection = 6,
                  .receive_connection = 6,
                  .session_id = 2};
  LinkUpdate retired;
  LinkHealth health;
  EXPECT_EQ(allocations_of([&] {
              TimePoint now{};
              retired = link.adopt(std::move(link_update), now);
              for (std::uint64_t tick = 0; tick < 2000; ++tick, now += 1ms) {
                if (tick == 1000) retired = link.adopt(std::move(next), now);
                (void)link.receive(now);
                link.send(some_telegram(tick).telegram, now);
              }
              health = link.health(now);
            }),
            0U);
  EXPECT_GT(health.accepted, 1000U);
  EXPECT_GT(health.malformed, 1000U);
  EXPECT_GT(health.foreign, 1000U);
  EXPECT_GT(health.replayed, 1000U);
}

}  // namespace
}  // namespace palp::link
