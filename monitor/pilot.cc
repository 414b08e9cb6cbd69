#include "monitor/pilot.h"

#include <algorithm>
#include <cmath>

#include "common/config/json.h"
#include "common/core/printable.h"
#include "monitor/protocol.h"

namespace palp::monitor {
namespace {

constexpr double kDrawnMax = 1.0;  // [m], no screen is as wide
constexpr std::size_t kNameMax = 40;

std::optional<double> drawn(const config::Json& json, std::string_view name) noexcept {
  const auto value = json.at_or_null(name).number();
  if (!value || !std::isfinite(*value) || std::abs(*value) > kDrawnMax) return std::nullopt;
  return value;
}

}  // namespace

bool Pilot::take(std::uint32_t client, std::string_view name) {
  if (client_ != 0) return client_ == client;
  client_ = client;
  name_ = printable(name.substr(0, kNameMax));
  measured_ = 0;
  awaited_ = {};
  newest_.held = false;
  press_ = 0;
  refused_ = 0;
  return true;
}

bool Pilot::give(std::uint32_t client) {
  if (client_ != client) return false;
  client_ = 0;
  name_.clear();
  return true;
}

std::optional<PointerReport> Pilot::heard_pong(std::uint32_t client,
                                               Duration round_trip,
                                               TimePoint now) noexcept {
  if (client != client_) return std::nullopt;
  round_trips_[measured_++ % kRoundTrips] = round_trip;
  awaited_ = {};
  return judge(round_trip, now);
}

std::optional<PointerReport> Pilot::awaits_pong(std::uint32_t client,
                                                Duration age,
                                                TimePoint now) noexcept {
  if (client != client_) return std::nullopt;
  awaited_ = age;
  return judge(age, now);
}

/// One is enough: the message that lets go may stand in the same queue.
std::optional<PointerReport> Pilot::judge(Duration round_trip, TimePoint now) noexcept {
  if (round_trip <= kRoundTripMax || !newest_.held) return std::nullopt;
  refused_ = press_;
  newest_ = let_go(now);
  return newest_;
}

Duration Pilot::round_trip() const noexcept {
  const std::size_t count = std::min(measured_, kRoundTrips);
  if (count == 0) return awaited_;
  auto sorted = round_trips_;
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count));
  const Duration newest = round_trips_[(measured_ - 1) % kRoundTrips];
  return std::max({sorted[(count * 19 + 19) / 20 - 1], newest, awaited_});
}

std::string_view Pilot::obstacle() const noexcept {
  if (round_trip() > kRoundTripMax) return "this page answers too late to hold a hand";
  if (measured_ == 0) return "the way to this page is not measured yet";
  return {};
}

std::optional<PointerReport> Pilot::hear(std::uint32_t client,
                                         std::string_view json,
                                         TimePoint now) {
  if (client == 0 || client != client_ || !is_shallow(json)) return std::nullopt;
  const auto message = config::Json::parse(json);
  const config::Json& press = message.at_or_null("press");
  const auto held = message.at_or_null("held").truth();
  const auto into = drawn(message, "into_m");
  const auto x = drawn(message, "x_m");
  const auto y = drawn(message, "y_m");
  constexpr double kPressMax = 4e9;
  if (!press.is_unsigned() || *press.number() > kPressMax || !held || !into || !x || !y) {
    return std::nullopt;
  }
  const auto number = static_cast<std::uint32_t>(*press.number());
  if (number < press_) return std::nullopt;  // of an earlier press
  if (number > press_ && *held) {
    press_ = number;
    ++presses_;
    if (!obstacle().empty()) refused_ = number;
  }
  newest_ = {.arrived_at = now,
             .press = presses_,
             .held = *held && number == press_ && refused_ != number,
             .into = *into,
             .x = *x,
             .y = *y};
  return newest_;
}

PointerReport Pilot::let_go(TimePoint now) const noexcept {
  PointerReport report = newest_;
  report.arrived_at = now;
  report.held = false;
  return report;
}

}  // namespace palp::monitor
