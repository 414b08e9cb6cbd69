#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "common/core/time.h"

/// The plainest control loop with the plainest link there is, for comparison: plain sockets, a
/// struct copied into a datagram, nothing of ours.
namespace palp::bench {

struct RawAccount {
  std::uint64_t ticks{};
  std::uint64_t missed{};          ///< periods without a tick
  std::vector<Duration> lateness;  ///< of each tick's beginning behind its deadline
  /// Of each datagram: its writing begins -> the kernel's receive stamp, and drain begins -> read.
  std::vector<Duration> latency;
  std::vector<Duration> reading;  ///< the latter part of it
};

/// 1 kHz at SCHED_FIFO 80, sleeping until 50 us before each deadline: sends one datagram a tick to
/// the connected `socket` and reads what has come there. Runs from construction to stop().
class RawLoop {
 public:
  /// The first tick is at `first`; room for `ticks_max` of them is made before it.
  RawLoop(int socket, TimePoint first, std::size_t ticks_max);
  /// Once.
  [[nodiscard]] RawAccount stop();

 private:
  void run(const std::stop_token& stop, int socket, TimePoint first);
  RawAccount account_;
  std::jthread thread_;  ///< last: it fills the account
};

/// A UDP socket on loopback with the kernel's receive stamps, connected to itself.
[[nodiscard]] int make_raw_socket();
/// Connects each to the other.
void join_raw_sockets(int one, int other);

/// Share of the machine's time that other guests took between construction and share().
class StolenTime {
 public:
  StolenTime() : before_{read()} {}
  [[nodiscard]] double share() const;

 private:
  struct Ticks {
    double stolen{};
    double all{};
  };
  [[nodiscard]] static Ticks read();
  Ticks before_;
};
constexpr double kStolenMax = 0.005;  ///< [-]; a round above it says nothing about a program

}  // namespace palp::bench
