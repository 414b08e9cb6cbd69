#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/core/time.h"
#include "common/io/device/register_port.h"

namespace palp {

/// A clock that a test turns; each look takes no time.
class TestClock final : public Clock {
 public:
  [[nodiscard]] TimePoint now() const noexcept override { return at; }
  TimePoint at{std::chrono::seconds{10}};
};

/// A device of registers in memory, with what may go wrong: no word of it is our driver's.
class FakeRegisters final : public io::RegisterPort {
 public:
  std::map<std::uint16_t, std::uint16_t> words;
  std::map<std::uint16_t, bool> coils;
  io::PortFault fault{};                   ///< of every transaction
  std::optional<std::uint16_t> deaf_at{};  ///< requests there are not answered
  bool openable{true};
  int opened{};
  int writes{};
  std::function<void(std::uint16_t address)> written{[](std::uint16_t) {}};

  io::PortFault open() override {
    ++opened;
    return openable ? io::PortFault::None : io::PortFault::NotOpen;
  }
  void close() override {}
  io::PortFault read(std::uint16_t address, std::span<std::uint16_t> out, bool /*input*/) override {
    if (fault != io::PortFault::None) return fault;
    if (address == deaf_at) return io::PortFault::NoReply;
    for (auto& word : out) word = words[address++];
    return fault;
  }
  io::PortFault write(std::uint16_t address, std::span<const std::uint16_t> in) override {
    if (fault != io::PortFault::None) return fault;
    if (address == deaf_at) return io::PortFault::NoReply;
    ++writes;
    std::uint16_t at = address;
    for (const auto word : in) words[at++] = word;
    written(address);
    return fault;
  }
  io::PortFault write_one(std::uint16_t address, std::uint16_t word) override {
    return write(address, std::span{&word, 1});
  }
  io::PortFault write_coil(std::uint16_t address, bool on) override {
    if (fault != io::PortFault::None) return fault;
    coils[address] = on;
    written(address);
    return fault;
  }
  io::PortFault exchange(std::uint16_t write_address,
                         std::span<const std::uint16_t> in,
                         std::uint16_t address,
                         std::span<std::uint16_t> out) override {
    const io::PortFault failed = write(write_address, in);
    return failed != io::PortFault::None ? failed : read(address, out, false);
  }
};

}  // namespace palp
