#include "common/record/session_encoder.h"

#include <cstring>
#include <variant>

#include "common/message/log_schema.h"
#include "common/record/notes.h"

namespace palp::record {
namespace {

using link::Role;
using message::Event;
using message::EventKind;

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

template <class Message>
TopicFormat format(Topic topic, Role site, std::string_view name) {
  message::LogSchema schema = message::log_schema<Message>(site == Role::Patient);
  return {.topic = topic,
          .name = std::string{site_name(site)} + "/" + std::string{name},
          .schema = std::move(schema.name),
          .descriptors = std::move(schema.descriptors)};
}

}  // namespace

std::string_view site_name(Role site) noexcept {
  return site == Role::Surgeon ? "surgeon" : "patient";
}

std::vector<TopicFormat> topics_of(Role site) {
  const bool surgeon = site == Role::Surgeon;
  std::vector<TopicFormat> topics{surgeon ? format<SurgeonFileTick>(Topic::Tick, site, "tick")
                                          : format<PatientFileTick>(Topic::Tick, site, "tick"),
                                  format<TickView>(Topic::TickView, site, "tick_view"),
                                  format<Arrived>(Topic::Arrived, site, "arrived"),
                                  format<LinkStatus>(Topic::Link, site, "link"),
                                  format<Event>(Topic::Event, site, "event")};
  if (surgeon) {
    topics.push_back(format<DepthArrived>(Topic::Depth, site, "depth"));
    topics.push_back(format<HandReading>(Topic::Hand, site, "hand"));
  } else {
    topics.push_back(format<DepthEstimate>(Topic::Depth, site, "depth"));
    topics.push_back(format<StageReading>(Topic::Stage, site, "stage"));
    topics.push_back(format<ForceReading>(Topic::Force, site, "force"));
  }
  topics.push_back(format<LinkHeard>(Topic::Heard, site, "heard"));
  topics.push_back(format<UserAsked>(Topic::User, site, "user"));
  topics.push_back(format<DevicesTold>(Topic::Devices, site, "devices"));
  if (surgeon) topics.push_back(format<PlantTruth>(Topic::Truth, site, "truth"));
  topics.push_back(surgeon ? format<MapArrived>(Topic::Map, site, "map")
                           : format<MapEstimate>(Topic::Map, site, "map"));
  topics.push_back(format<MapCell>(Topic::MapCell, site, "map_cell"));
  return topics;
}

template <class Message>
Prepared SessionEncoder::write(Topic topic, TimePoint at, const Message& message) noexcept {
  size_ = message::write_log(message, bytes_);
  return {.topic = topic, .at = at, .size = size_};
}

std::optional<Prepared> SessionEncoder::prepare(const Record& record,
                                                std::uint64_t records_dropped) {
  using Answer = std::optional<Prepared>;
  const bool surgeon = site_ == Role::Surgeon;
  // What the other site alone says is left out.
  const auto of_site = [this](bool here, Topic topic, const auto& one) -> Answer {
    return here ? Answer{write(topic, one.at, one)} : std::nullopt;
  };
  return std::visit(
      Overloaded{[&](const SiteTick& tick) -> Answer {
                   if (surgeon)
                     return prepare(SurgeonFileTick{.at = tick.at, .tick = tick, .given = {}});
                   return prepare(PatientFileTick{.at = tick.at, .tick = tick, .given = {}});
                 },
                 [&](const Arrived& arrived) -> Answer {
                   return write(Topic::Arrived, arrived.at, arrived);
                 },
                 [&](LinkStatus status) -> Answer {
                   status.records_dropped = records_dropped;
                   return write(Topic::Link, status.at, status);
                 },
                 [&](const Note& note) -> Answer {
                   const Event event{.kind = EventKind::Note,
                                     .code = note.code,
                                     .text = note_text(note.code),
                                     .detail = note.detail};
                   return write(Topic::Event, note.at, event);
                 },
                 [&](const Transition& transition) -> Answer {
                   const Event event{.kind = EventKind::Transition,
                                     .code = transition.reason,
                                     .text = note_text(transition.reason),
                                     .from = transition.from,
                                     .to = transition.to};
                   return write(Topic::Event, transition.at, event);
                 },
                 [&](const DepthEstimate& estimate) -> Answer {
                   if (surgeon) return std::nullopt;
                   return write(Topic::Depth, estimate.stroke_ended_at, estimate);
                 },
                 [&](const DepthArrived& one) { return of_site(surgeon, Topic::Depth, one); },
                 [&](const HandReading& one) { return of_site(surgeon, Topic::Hand, one); },
                 [&](const StageReading& one) { return of_site(!surgeon, Topic::Stage, one); },
                 [&](const ForceReading& one) { return of_site(!surgeon, Topic::Force, one); },
                 [&](const LinkHeard& one) { return of_site(true, Topic::Heard, one); },
                 [&](const UserAsked& one) { return of_site(true, Topic::User, one); },
                 [&](const DevicesTold& one) { return of_site(true, Topic::Devices, one); },
                 [&](const PlantTruth& one) { return of_site(surgeon, Topic::Truth, one); },
                 [&](const MapEstimate& one) { return of_site(!surgeon, Topic::Map, one); },
                 [&](const MapArrived& one) { return of_site(surgeon, Topic::Map, one); },
                 [&](const MapCell& one) { return of_site(true, Topic::MapCell, one); }},
      record);
}

Prepared SessionEncoder::prepare(const TickView& view) noexcept {
  return write(Topic::TickView, view.newest.at, view);
}

Prepared SessionEncoder::prepare(const SurgeonFileTick& tick) noexcept {
  return write(Topic::Tick, tick.at, tick);
}

Prepared SessionEncoder::prepare(const PatientFileTick& tick) noexcept {
  return write(Topic::Tick, tick.at, tick);
}

void SessionEncoder::store(std::byte* place) const noexcept {
  if (size_ > 0) std::memcpy(place, bytes_.data(), size_);  // a message of zeros has no bytes
}

}  // namespace palp::record
