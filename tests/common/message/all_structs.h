#pragma once

#include "common/message/log_bytes.h"
#include "common/message/telegram.h"

/// Every struct that has a list, by what it is for.
namespace palp::message {

/// Calls visit.operator()<Struct>() for each.
template <class... Structs>
void each_type(auto&& visit) {
  (visit.template operator()<Structs>(), ...);
}

void each_struct(auto&& visit) {
  each_type<WavePayload,
            TdpaPayload,
            ModelPayload,
            PortSample,
            Incoming,
            SiteReport,
            DepthReport,
            MapReport,
            WireTelegram,
            ClockOffset,
            LinkHealth,
            SiteTick,
            Arrived,
            LinkStatus,
            Note,
            Transition,
            DepthEstimate,
            DepthArrived,
            HandReading,
            StageReading,
            ForceReading,
            LinkHeard,
            UserCommand,
            UserAsked,
            HandFacts,
            StageFacts,
            ForceSensorFacts,
            DeviceFacts,
            DevicesTold,
            PlantTruth,
            MapEstimate,
            MapArrived,
            MapCell,
            SurgeonGiven,
            PatientGiven,
            SurgeonFileTick,
            PatientFileTick,
            TickView,
            Event>(visit);
}

/// Those that are messages of the log.
template <class... Messages>
void each_of(MessageList<Messages...> /*list*/, auto&& visit) {
  each_type<Messages...>(visit);
}
void each_log_message(auto&& visit) { each_of(LogMessages{}, visit); }

/// Whether a site's file has this message.
template <class Message>
constexpr bool in_file_of(bool patient) {
  constexpr Names kNames = fields<Message>.names;
  return !kNames.one_site || kNames.log_patient.empty() != patient;
}

}  // namespace palp::message
