#include "monitor/desk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/config/json.h"
#include "monitor/offers.h"
#include "monitor/status_json.h"

namespace palp::monitor {
namespace {

using config::Json;
using record::Topic;

constexpr Duration kTellWayStep = std::chrono::milliseconds{100};  ///< of an answer waited for
constexpr std::size_t kKeptMax = 200;
constexpr std::size_t kSubscriptionsMax = 64;
constexpr std::string_view kPointerTopic = "monitor/pointer";

bool is_camera(std::uint32_t channel) noexcept {
  return channel == kCameraChannel || channel == kJpegChannel;
}

}  // namespace

Desk::Desk(const DeskConfig& config, Controls controls)
    : config_{config},
      controls_{controls},
      channels_{channels_of(config.site, controls)},
      services_{services_of(controls)} {}

std::uint32_t Desk::join(Right right, TimePoint now) {
  if (right == Right::None || clients_.size() >= kClientsMax) return 0;
  const std::uint32_t number = ++joined_;
  Client& client = clients_[number];
  client.right = right;
  client.heard_at = now;
  const bool controllable = right == Right::Control && !services_.empty();
  Greeting greeting{.name = config_.program,
                    .run = config_.run,
                    .controllable = controllable,
                    .facts = config_.facts};
  greeting.facts.emplace_back("site", record::site_name(config_.site));
  greeting.facts.emplace_back("client", std::to_string(number));
  greeting.facts.emplace_back("right", controllable ? "control" : "view");
  greeting.facts.emplace_back("pointer", controls_.pointer != nullptr ? "yes" : "no");
  greeting.facts.emplace_back("study", controls_.study != nullptr ? "yes" : "no");
  client.outbox.push({.text = true, .passing = false, .body = greeting_text(greeting)});
  client.outbox.push({.text = true, .passing = false, .body = advertise_text(channels_)});
  if (controllable) {
    client.outbox.push({.text = true, .passing = false, .body = services_text(services_)});
  }
  return number;
}

void Desk::leave(std::uint32_t client, TimePoint now) {
  if (pilot_.give(client)) {
    controls_.pointer->put(pilot_.let_go(now));
    (void)ask(Request::Kind::PilotGave, client);
  }
  clients_.erase(client);
  want_pictures();
}

/// Nobody looks: nothing has to be sent.
void Desk::want_pictures() {
  if (controls_.camera == nullptr) return;
  wish_.watched = std::ranges::any_of(clients_, [](const auto& client) {
    return std::ranges::any_of(client.second.subscriptions,
                               [](const auto& one) { return is_camera(one.second); });
  });
  controls_.camera->wishes.put(wish_);
}

void Desk::want_key(Client& client) {
  client.needs_key = true;
  ++wish_.keys;
  want_pictures();
}

void Desk::heard_pong(std::uint32_t number, Duration round_trip, TimePoint now) {
  Client& client = clients_.at(number);
  tell_way(client, round_trip);
  end_press(client, pilot_.heard_pong(number, round_trip, now));
}

void Desk::awaits_pong(std::uint32_t number, Duration age, TimePoint now) {
  Client& client = clients_.at(number);
  if (age > client.told_way + kTellWayStep) tell_way(client, age);
  end_press(client, pilot_.awaits_pong(number, age, now));
}

void Desk::tell_way(Client& client, Duration round_trip) {
  client.told_way = round_trip;
  const std::string json = client_json(round_trip);
  send(client, kClientChannel, told_, std::as_bytes(std::span{json}));
}

void Desk::end_press(Client& client, const std::optional<PointerReport>& report) {
  if (!report) return;
  controls_.pointer->put(*report);
  tell(client, Level::Warning, "the hand was let go of: this page answers too late to hold it");
}

bool Desk::within_budget(Client& client, TimePoint now) noexcept {
  client.budget = std::min(kMessagesPerSecond,
                           client.budget + kMessagesPerSecond * seconds(now - client.heard_at));
  client.heard_at = now;
  if (client.budget < 1) return false;
  client.budget -= 1;
  return true;
}

bool Desk::hear_text(std::uint32_t number, std::string_view text, TimePoint now) {
  Client& client = clients_.at(number);
  if (!within_budget(client, now)) return false;
  const auto said = read_client_text(text);
  if (!said) {
    tell(client, Level::Error, "this is no text of the protocol");
    return true;
  }
  for (const auto& one : said->subscriptions) subscribe(client, one);
  for (const auto& one : said->publications) {
    if (client.right != Right::Control || one.topic != kPointerTopic || one.encoding != "json") {
      tell(client, Level::Warning, "this client may not publish there");
      continue;
    }
    client.pointer_channel = one.id;
    client.publishes = true;
  }
  if (said->op == ClientText::Op::Unsubscribe) {
    for (const std::uint32_t id : said->ids) client.subscriptions.erase(id);
    want_pictures();
  } else if (said->op == ClientText::Op::Unadvertise) {
    if (std::ranges::find(said->ids, client.pointer_channel) != said->ids.end()) {
      client.publishes = false;
    }
  }
  return true;
}

/// Who comes late is told of what happened before.
void Desk::subscribe(Client& client, const ClientText::Subscription& wanted) {
  const bool known = std::ranges::any_of(
      channels_, [&wanted](const Channel& one) { return one.id == wanted.channel; });
  if (!known || client.subscriptions.size() >= kSubscriptionsMax) {
    return tell(client, Level::Warning, "there is no such channel");
  }
  if (!client.subscriptions.emplace(wanted.id, wanted.channel).second) {
    return tell(client, Level::Warning, "this subscription exists");
  }
  if (is_camera(wanted.channel)) want_key(client);
  if (wanted.channel == kStudyChannel && !study_.empty()) {
    send(client, kStudyChannel, told_, std::as_bytes(std::span{study_}));
  }
  for (const auto* kept : {&kept_, &cells_}) {
    for (const Kept& one : *kept) {
      if (one.channel != wanted.channel) continue;
      client.outbox.push(
          {.text = false,
           .passing = false,
           .body = message_bytes(wanted.id, one.stamp, std::as_bytes(std::span{one.bytes}))});
    }
  }
}

bool Desk::hear_bytes(std::uint32_t number, std::string_view bytes, TimePoint now) {
  Client& client = clients_.at(number);
  if (!within_budget(client, now)) return false;
  const auto said = read_client_bytes(bytes);
  if (!said) {
    tell(client, Level::Error, "these are no bytes of the protocol");
  } else if (said->call) {
    answer_call(number, client, *said, now);
  } else if (client.publishes && said->id == client.pointer_channel) {
    hear_pointer(number, said->payload, now);
  } else {
    tell(client, Level::Warning, "this client has no such channel");
  }
  return true;
}

void Desk::hear_pointer(std::uint32_t number, std::string_view json, TimePoint now) {
  if (controls_.pointer == nullptr) return;
  if (const auto report = pilot_.hear(number, json, now)) controls_.pointer->put(*report);
}

void Desk::answer_call(std::uint32_t number,
                       Client& client,
                       const ClientBytes& call,
                       TimePoint now) {
  const bool known =
      std::ranges::any_of(services_, [&call](const Service& one) { return one.id == call.id; });
  std::string refusal;
  if (client.right != Right::Control) {
    refusal = "this client may only look";
  } else if (!known || call.encoding != "json") {
    refusal = "there is no such service";
  }
  if (!refusal.empty()) {
    client.outbox.push({.text = true,
                        .passing = false,
                        .body = call_failure_text(call.id, call.call_id, refusal)});
    return;
  }
  const std::string why = serve(number, call, now);
  const Json answer{{"ok", why.empty()}, {"why", why}};
  client.outbox.push({.text = false,
                      .passing = false,
                      .body = call_answer_bytes(call.id, call.call_id, answer.dump())});
}

std::string Desk::serve(std::uint32_t number, const ClientBytes& call, TimePoint now) {
  switch (call.id) {
    case kMark:
      return ask(Request::Kind::Mark, number);
    case kStop:
      if (controls_.stops != nullptr) controls_.stops->put(++stops_);
      // The loop has it already; whether the file gets its note changes nothing.
      (void)ask(Request::Kind::Stop, number);
      return {};
    case kReset:
      return ask(Request::Kind::Reset, number);
    case kEnd:
      return ask(Request::Kind::End, number);
    case kTake: {
      const auto request = is_shallow(call.payload) ? Json::parse(call.payload) : Json{};
      const auto name = request.at_or_null("name").text().value_or("");
      if (pilot_.client() == number) return {};
      if (!pilot_.take(number, name)) {
        const std::string who = pilot_.name().empty() ? "" : " (" + pilot_.name() + ")";
        return "client " + std::to_string(pilot_.client()) + who + " has the pointer";
      }
      (void)ask(Request::Kind::PilotTook, number);
      return {};
    }
    case kGive:
      if (!pilot_.give(number)) return "this client does not have the pointer";
      controls_.pointer->put(pilot_.let_go(now));
      (void)ask(Request::Kind::PilotGave, number);
      return {};
    case kAnswer:
      return answer_study(call, now);
    default:
      return "there is no such service";
  }
}

/// Whether it was the time for an answer, the study knows.
std::string Desk::answer_study(const ClientBytes& call, TimePoint now) {
  const auto said = is_shallow(call.payload) ? Json::parse(call.payload) : Json{};
  const auto trial = said.at_or_null("trial").number();
  const auto choice = said.at_or_null("choice").number();
  const auto counts = [](const std::optional<double>& number) {
    return number && *number >= 1 && *number <= 1e9 && *number == std::floor(*number);
  };
  if (!counts(trial) || !counts(choice)) return "this answer names no trial or no choice";
  const StudyAnswer answer{.trial = static_cast<std::uint32_t>(*trial),
                           .choice = static_cast<std::uint32_t>(*choice),
                           .at = now};
  if (controls_.study->answers.try_enqueue(answer)) return {};
  return "the study has not taken the answers before this one";
}

std::string Desk::ask(Request::Kind kind, std::uint32_t client) {
  if (controls_.requests->try_enqueue({kind, client})) return {};
  return "the program has not taken the requests before this one; nothing was done";
}

void Desk::tell(Client& client, Level level, std::string_view sentence) {
  client.outbox.push({.text = true, .passing = true, .body = status_text(level, sentence)});
}

void Desk::send(Client& client,
                std::uint32_t channel,
                std::uint64_t stamp,
                std::span<const std::byte> payload) {
  for (const auto& [id, wanted] : client.subscriptions) {
    if (wanted != channel) continue;
    client.outbox.push({.text = false, .passing = true, .body = message_bytes(id, stamp, payload)});
  }
}

void Desk::send(std::uint32_t channel, std::uint64_t stamp, std::span<const std::byte> payload) {
  for (auto& [number, client] : clients_) send(client, channel, stamp, payload);
}

void Desk::keep(const LiveMessage& message, std::deque<Kept>& in, std::size_t most) {
  std::string bytes(message.size, '\0');
  std::ranges::transform(
      message.payload(), bytes.begin(), [](std::byte one) { return static_cast<char>(one); });
  in.push_back({channel_id(message.topic), message.stamp, std::move(bytes)});
  if (in.size() > most) in.pop_front();
}

void Desk::publish(const LiveMessage& message) {
  const std::uint32_t channel = channel_id(message.topic);
  if (message.topic == Topic::Event || message.topic == Topic::Depth ||
      message.topic == Topic::Map) {
    keep(message, kept_, kKeptMax);
  } else if (message.topic == Topic::MapCell) {
    keep(message, cells_, kMapCellsMax);
  }
  send(channel, message.stamp, message.payload());
}

void Desk::publish_study() {
  if (controls_.study == nullptr) return;
  while (controls_.study->shown.try_dequeue(study_)) {
    send(kStudyChannel, told_, std::as_bytes(std::span{study_}));
  }
}

void Desk::publish(const LiveStatus& status) {
  if (status.stamp == told_) return;
  told_ = status.stamp;
  const std::string json = status_json(status, pilot_, clients_.size());
  send(kStatusChannel, status.stamp, std::as_bytes(std::span{json}));
}

/// To a client that missed one, what rests on that one is of no use.
void Desk::publish(const video::CameraFrame& frame, std::uint64_t stamp) {
  const std::uint32_t channel = frame.jpeg ? kJpegChannel : kCameraChannel;
  const auto message = video::camera_message(frame, stamp);
  for (auto& [number, client] : clients_) {
    for (const auto& [id, wanted] : client.subscriptions) {
      if (wanted != channel) continue;
      if (client.outbox.take_broken()) want_key(client);
      if (client.needs_key && !frame.key) continue;
      client.needs_key = false;
      client.outbox.push({.text = false,
                          .passing = true,
                          .chained = true,
                          .body = message_bytes(id, stamp, message)});
    }
  }
}

void Desk::publish(const VideoShown& shown, std::uint64_t stamp) {
  const std::string json = video_json(shown);
  send(kVideoChannel, stamp, std::as_bytes(std::span{json}));
}

}  // namespace palp::monitor
