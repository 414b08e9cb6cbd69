#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/process/descriptor.h"

namespace palp::io {

/// One of two ends between a program and its child: whole messages, in order, both ways. It has no
/// name: nobody reaches it but who holds an end. Never blocks. Thread: its owner's.
class MessagePipe {
 public:
  static constexpr std::size_t kMessageMax = 8192;  ///< [bytes]

  /// Both ends. The error is a CannotOpen.
  [[nodiscard]] static Result<std::pair<MessagePipe, MessagePipe>> make();
  /// The end that a parent left open as this number; no such end is bad input.
  [[nodiscard]] static Result<MessagePipe> adopt(int number);

  /// @returns false: it did not leave, for it is empty, or the other end does not read or is gone.
  bool send(std::string_view message) noexcept;
  /// The oldest that waits. Longer ones than kMessageMax come cut off.
  [[nodiscard]] std::optional<std::string> receive();
  /// Until receive() found the other end gone.
  [[nodiscard]] bool open() const noexcept { return open_; }
  /// Waits up to `span` [ms, whole ones count] for a message.
  void wait(Duration span) const noexcept;
  [[nodiscard]] int number() const noexcept { return descriptor_.number(); }

 private:
  explicit MessagePipe(Descriptor descriptor) noexcept : descriptor_{std::move(descriptor)} {}

  Descriptor descriptor_;
  bool open_{true};
};

}  // namespace palp::io
