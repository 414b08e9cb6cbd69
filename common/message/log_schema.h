#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/message/log_bytes.h"

namespace palp::message {

/// What a session file says of one of its messages, so that any reader can read it.
struct LogSchema {
  std::string name;                    ///< "palp.session.SurgeonTick"
  std::vector<std::byte> descriptors;  ///< FileDescriptorSet: the message and the types it uses
};

/// Of a message of log_bytes.h, or of the patient's where the two sites' differ.
template <class Message>
[[nodiscard]] LogSchema log_schema(bool of_patient);

/// Only the name: "SurgeonTick".
template <class Message>
[[nodiscard]] std::string_view log_name(bool of_patient) noexcept;

inline constexpr std::string_view kLogPackage{"palp.session"};

}  // namespace palp::message
