#pragma once

#include <cstddef>
#include <span>

#include "common/message/given.h"
#include "common/message/record.h"
#include "common/message/tick_view.h"

/// The messages of proto/session_log.proto. Their instants travel beside them, as stamps of the
/// file. Thread: any; allocates nothing.
namespace palp::message {

template <class... Messages>
struct MessageList {};

/// All of them: what has bytes and a schema, is decoded, and is held against the .proto.
using LogMessages = MessageList<SurgeonFileTick,
                                PatientFileTick,
                                TickView,
                                Arrived,
                                LinkStatus,
                                Event,
                                DepthEstimate,
                                DepthArrived,
                                HandReading,
                                StageReading,
                                ForceReading,
                                LinkHeard,
                                UserAsked,
                                DevicesTold,
                                PlantTruth,
                                MapEstimate,
                                MapArrived,
                                MapCell,
                                SurgeonGiven,
                                PatientGiven>;

/// Larger than any message of the log.
inline constexpr std::size_t kLogMessageSizeMax = 1024;  ///< [bytes]

/// @returns bytes written.
template <class Message>
std::size_t write_log(const Message& from, std::span<std::byte, kLogMessageSizeMax> out) noexcept;

/// Any bytes may be given. Text refers to the bytes. Unknown fields are skipped.
/// @returns false where they are no such message.
template <class Message>
[[nodiscard]] bool read_log(std::span<const std::byte> bytes, Message& to) noexcept;

/// True where every enumerator is known; numbers may be anything.
template <class Message>
[[nodiscard]] bool in_log_range(const Message& message) noexcept;

}  // namespace palp::message
