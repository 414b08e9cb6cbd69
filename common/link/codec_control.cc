#include "common/link/codec_control.h"

#include <algorithm>
#include <string_view>

#include "common/core/check.h"
#include "proto/link.pb.h"

namespace palp::link {
namespace {

std::string printable(std::string_view text, std::size_t size_max) {
  std::string clean{text.substr(0, size_max)};
  std::replace_if(
      clean.begin(), clean.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return clean;
}

template <class Message>
ControlBytes serialize(const Message& message) {
  ControlBytes out;
  out.size = message.ByteSizeLong();
  PALP_CHECK(out.size <= out.bytes.size(), "control messages are short");
  message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(out.bytes.data()));
  return out;
}

template <class Message>
bool parse(std::span<const std::byte> bytes, Message& message) {
  return bytes.size() <= kControlSizeMax &&
         message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

/// All fields, so that every Hello is as long as its answer.
void put(const DeviceFacts& facts, wire::Devices& out) {
  constexpr HandFacts kNoHand{0, 0, 0, 0};
  constexpr StageFacts kNoStage{0, 0, 0, 0, 0, 0, 0, 0, false};
  constexpr ForceSensorFacts kNoSensor{0, 0, 0, 0, 0, 0};
  const HandFacts hand = facts.hand.value_or(kNoHand);
  out.set_hand_axes(hand.axes);
  out.set_hand_force_peak_n(hand.force_peak);
  out.set_hand_force_continuous_n(hand.force_continuous);
  out.set_hand_rate_hz(hand.rate);
  const StageFacts stage = facts.stage.value_or(kNoStage);
  out.set_stage_axes(stage.axes);
  out.set_stage_travel_min_m(stage.travel_min);
  out.set_stage_travel_max_m(stage.travel_max);
  out.set_stage_travel_side_m(stage.travel_side);
  out.set_stage_speed_m_per_s(stage.speed);
  out.set_stage_acceleration_m_per_s2(stage.acceleration);
  out.set_stage_rate_hz(stage.rate);
  out.set_stage_lag_s(stage.lag);
  out.set_stage_drags(stage.drags);
  const ForceSensorFacts sensor = facts.sensor.value_or(kNoSensor);
  out.set_sensor_pole_hz(sensor.pole);
  out.set_sensor_step_n(sensor.step);
  out.set_sensor_range_n(sensor.range);
  out.set_sensor_noise_n(sensor.noise);
  out.set_sensor_rate_hz(sensor.rate);
  out.set_sensor_lag_s(sensor.lag);
}

DeviceFacts facts_of(const wire::Devices& in) {
  DeviceFacts facts;
  if (in.hand_axes() != 0) {
    facts.hand = HandFacts{.axes = in.hand_axes(),
                           .force_peak = in.hand_force_peak_n(),
                           .force_continuous = in.hand_force_continuous_n(),
                           .rate = in.hand_rate_hz()};
  }
  if (in.stage_axes() != 0) {
    facts.stage = StageFacts{.axes = in.stage_axes(),
                             .travel_min = in.stage_travel_min_m(),
                             .travel_max = in.stage_travel_max_m(),
                             .travel_side = in.stage_travel_side_m(),
                             .speed = in.stage_speed_m_per_s(),
                             .acceleration = in.stage_acceleration_m_per_s2(),
                             .rate = in.stage_rate_hz(),
                             .lag = in.stage_lag_s(),
                             .drags = in.stage_drags()};
  }
  if (in.sensor_rate_hz() != 0) {
    facts.sensor = ForceSensorFacts{.pole = in.sensor_pole_hz(),
                                    .step = in.sensor_step_n(),
                                    .range = in.sensor_range_n(),
                                    .noise = in.sensor_noise_n(),
                                    .rate = in.sensor_rate_hz(),
                                    .lag = in.sensor_lag_s()};
  }
  return facts;
}

}  // namespace

ControlBytes encode(const Hello& hello) {
  wire::Hello message;
  message.set_protocol_version(hello.protocol_version);
  message.set_role(hello.role == Role::Surgeon ? wire::SURGEON : wire::PATIENT);
  message.set_session_id(hello.session_id);
  message.set_peer_session_id(hello.peer_session_id);
  message.set_connection_id(hello.connection_id);
  message.set_settings_hash(hello.settings_hash);
  message.set_coupling(printable(hello.coupling, kNameSizeMax));
  message.set_git(printable(hello.git, kNameSizeMax));
  put(hello.devices, *message.mutable_devices());
  return serialize(message);
}

ControlBytes encode(const Bye& bye) {
  wire::Bye message;
  message.set_session_id(bye.session_id);
  message.set_peer_session_id(bye.peer_session_id);
  message.set_reason(static_cast<wire::Bye::Reason>(bye.reason));
  message.set_text(printable(bye.text, kTextSizeMax));
  return serialize(message);
}

std::optional<Hello> decode_hello(std::span<const std::byte> bytes) {
  wire::Hello message;
  if (!parse(bytes, message)) return std::nullopt;
  if (message.role() != wire::SURGEON && message.role() != wire::PATIENT) return std::nullopt;
  if (message.session_id() == 0) return std::nullopt;
  if (message.coupling().size() > kNameSizeMax || message.git().size() > kNameSizeMax) {
    return std::nullopt;
  }
  return Hello{.protocol_version = message.protocol_version(),
               .role = message.role() == wire::SURGEON ? Role::Surgeon : Role::Patient,
               .session_id = message.session_id(),
               .peer_session_id = message.peer_session_id(),
               .connection_id = message.connection_id(),
               .settings_hash = message.settings_hash(),
               .coupling = printable(message.coupling(), kNameSizeMax),
               .git = printable(message.git(), kNameSizeMax),
               .devices = facts_of(message.devices())};
}

std::optional<Bye> decode_bye(std::span<const std::byte> bytes) {
  wire::Bye message;
  if (!parse(bytes, message)) return std::nullopt;
  if (message.reason() < 0 || message.reason() >= kByeReasonCount) return std::nullopt;
  if (message.text().size() > kTextSizeMax) return std::nullopt;
  return Bye{.session_id = message.session_id(),
             .peer_session_id = message.peer_session_id(),
             .reason = static_cast<ByeReason>(message.reason()),
             .text = printable(message.text(), kTextSizeMax)};
}

}  // namespace palp::link
