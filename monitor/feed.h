#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/message/log_bytes.h"
#include "common/message/tick_view.h"
#include "common/record/session_encoder.h"
#include "common/record/wall_clock.h"

namespace palp::monitor {

/// A message as the session file has it, on its way to the clients.
struct LiveMessage {
  record::Topic topic{};
  std::uint64_t stamp{};  ///< ns since 1970, the sample's own instant
  std::uint16_t size{};   ///< [bytes]
  std::array<std::byte, message::kLogMessageSizeMax> bytes{};

  [[nodiscard]] std::span<const std::byte> payload() const noexcept {
    return std::span{bytes}.first(size);
  }
};

/// The newest of all that a picture of the session needs at once.
struct LiveStatus {
  std::uint64_t stamp{};  ///< ns since 1970
  SiteTick tick;
  std::uint16_t reason{};   ///< of the last change of state; notes.h
  std::uint16_t refused{};  ///< why the last press of the pedal did not engage; 0: it did
  LinkHeard heard;
  bool peer_sampled{};
  double peer_position{};   ///< [m], surgeon: the tip, patient: the hand
  double peer_force{};      ///< [N], surgeon: of the contact
  double peer_force_min{};  ///< [N], since the status before
  double peer_force_max{};  ///< [N], likewise
  std::uint64_t ticks{};
  std::uint64_t ticks_missed{};
  std::uint64_t dropped{};  ///< messages that found the queue full
  bool recording{};
};
static_assert(std::is_trivially_copyable_v<LiveStatus>, "crosses threads by copy");

/// From the record thread to the monitor's: the same encoder that fills the session file makes the
/// messages of up to 50 Hz once more for the screen, whether there is a file or not. A full queue
/// drops the message and counts it; the record thread never waits.
class Feed {
 public:
  Feed(link::Role site, const record::WallClock& clock, Duration period);

  [[nodiscard]] link::Role site() const noexcept { return site_; }
  /// [ns] since 1970, on the file's line. Thread: any.
  [[nodiscard]] std::uint64_t stamp(TimePoint at) const noexcept { return clock_.stamp(at); }

  /// Each record that the session file gets, in the same order. Thread: record.
  void take(const Record& record) noexcept;
  /// After all that waited was taken. Thread: record.
  void tell(bool recording) noexcept;

  /// false: no more. Thread: monitor.
  [[nodiscard]] bool next(LiveMessage& message) noexcept { return queue_.try_dequeue(message); }
  [[nodiscard]] const LiveStatus& status() noexcept { return status_.get(); }  ///< Thread: monitor

 private:
  void view(const SiteTick& tick) noexcept;
  void hear(const Incoming& incoming) noexcept;
  void count(const SiteTick& tick) noexcept;
  void put(const record::Prepared& prepared) noexcept;

  static constexpr std::size_t kMessagesMax = 1024;

  link::Role site_;
  record::WallClock clock_;
  Duration period_;
  record::SessionEncoder encoder_;
  TickView view_;
  LiveStatus now_;
  SignalView peer_force_;  ///< [N]
  bool peer_told_{true};
  LiveMessage message_;
  SpscQueue<LiveMessage> queue_{kMessagesMax};  ///< writer: record, reader: monitor
  Mailbox<LiveStatus> status_;                  ///< writer: record, reader: monitor
};

}  // namespace palp::monitor
