#pragma once

#include <string>
#include <utility>

#include "common/core/result.h"
#include "common/io/process/descriptor.h"

namespace palp::study {

/// Speaks to the live control of a relay that runs beside this program. Thread: its maker's.
class RelayLine {
 public:
  /// `path`: of its socket in the file system. The error is a CannotOpen.
  [[nodiscard]] static Result<RelayLine> connect(const std::string& path);

  /// The way down takes so much longer [ms], a second from now on. @returns false: nobody listens.
  bool delay(double milliseconds);

 private:
  explicit RelayLine(io::Descriptor socket) noexcept : socket_{std::move(socket)} {}

  io::Descriptor socket_;
};

}  // namespace palp::study
