#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <string>
#include <utility>

namespace palp::monitor {

/// A frame of the protocol on its way to one client.
struct Frame {
  bool text{};     ///< else bytes
  bool passing{};  ///< a newer one makes up for its loss
  bool chained{};  ///< of the camera: it rests on the chained one before it
  std::string body;
};

/// What one client has not taken yet, bounded: where it takes nothing, passing frames give way, the
/// oldest first. Answers wait; a client that lets even those pile up, in bytes or in number, is
/// given up. Thread: one.
class Outbox {
 public:
  static constexpr std::size_t kStayingMax = 2048;  ///< frames that do not give way
  /// Chained frames that wait: beyond 250 ms of them a key frame is better than the rest.
  static constexpr std::size_t kChainedMax = 8;

  explicit Outbox(std::size_t bound) noexcept : bound_{bound} {}

  void push(Frame frame);
  [[nodiscard]] bool empty() const noexcept { return frames_.empty(); }
  /// The oldest: it is on its way from now on and stays until pop(). Not empty.
  [[nodiscard]] const Frame& begin_first() noexcept {
    sending_ = true;
    return frames_.front();
  }
  void pop();

  [[nodiscard]] std::size_t waiting() const noexcept { return waiting_; }  ///< [bytes]
  /// Since the last call a chained frame gave way, and all that waited behind it with it.
  [[nodiscard]] bool take_broken() noexcept { return std::exchange(broken_, false); }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
  [[nodiscard]] bool hopeless() const noexcept {
    return waiting_ > 2 * bound_ || staying_ > kStayingMax;
  }

 private:
  void give_way(std::list<Frame>::iterator& one);
  void break_chain();

  std::size_t bound_;  ///< [bytes]
  std::list<Frame> frames_;
  std::size_t waiting_{};
  std::size_t staying_{};  ///< of the frames
  std::size_t chained_{};  ///< likewise
  std::uint64_t dropped_{};
  bool sending_{};
  bool broken_{};
};

}  // namespace palp::monitor
