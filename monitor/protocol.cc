#include "monitor/protocol.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/config/json.h"

namespace palp::monitor {
namespace {

using config::Json;

constexpr char kMessage = 1;
constexpr char kCall = 2;
constexpr char kAnswer = 3;
constexpr std::size_t kListMax = 64;  ///< parts of one text; more than any client has topics
constexpr std::size_t kTopicMax = 80;
constexpr int kNestingMax = 8;

std::string base64(std::span<const std::byte> bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three =
          three << 8U | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool there = i + k <= bytes.size();
      out += there ? kDigits[three >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return out;
}

template <class Number>
void append(std::string& out, Number value) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    out += static_cast<char>(static_cast<unsigned char>(value >> (8 * i) & 0xFFU));
  }
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return value;
}

std::optional<std::uint32_t> id_of(const Json& json) noexcept {
  const auto number = json.number();
  constexpr double kMax = std::numeric_limits<std::uint32_t>::max();
  if (!json.is_unsigned() || *number > kMax) return std::nullopt;
  return static_cast<std::uint32_t>(*number);
}

std::span<const Json> list_in(const Json& json, std::string_view name) noexcept {
  const auto parts = json.at_or_null(name).parts();
  return parts.first(std::min(parts.size(), kListMax));
}

void read_subscriptions(const Json& json, ClientText& text) {
  for (const Json& one : list_in(json, "subscriptions")) {
    const auto id = id_of(one.at_or_null("id"));
    const auto channel = id_of(one.at_or_null("channelId"));
    if (id && channel) text.subscriptions.push_back({*id, *channel});
  }
}

void read_publications(const Json& json, ClientText& text) {
  for (const Json& one : list_in(json, "channels")) {
    const auto id = id_of(one.at_or_null("id"));
    const auto topic = one.at_or_null("topic").text();
    const auto encoding = one.at_or_null("encoding").text();
    if (!id || !topic || !encoding || topic->size() > kTopicMax) continue;
    text.publications.push_back({*id, std::string{*topic}, std::string{*encoding}});
  }
}

void read_ids(const Json& json, std::string_view name, ClientText& text) {
  for (const Json& one : list_in(json, name)) {
    if (const auto id = id_of(one)) text.ids.push_back(*id);
  }
}

}  // namespace

std::string_view subprotocol_of(std::string_view offered) noexcept {
  constexpr std::string_view kBlanks = " \t";
  while (!offered.empty()) {
    std::string_view one = offered.substr(0, offered.find(','));
    offered.remove_prefix(std::min(offered.size(), one.size() + 1));
    one.remove_prefix(std::min(one.size(), one.find_first_not_of(kBlanks)));
    one = one.substr(0, one.find_last_not_of(kBlanks) + 1);
    const auto* const ours = std::ranges::find(kSubprotocols, one);
    if (ours != std::end(kSubprotocols)) return *ours;
  }
  return {};
}

Channel channel_of(const record::TopicFormat& format) {
  return {.id = static_cast<std::uint32_t>(format.topic) + 1,
          .topic = format.name,
          .encoding = "protobuf",
          .schema_name = format.schema,
          .schema = base64(format.descriptors)};
}

std::string greeting_text(const Greeting& greeting) {
  Json json;
  json["op"] = "serverInfo";
  json["name"] = greeting.name;
  json["capabilities"] = Json::array();
  json["supportedEncodings"] = Json::array();
  if (greeting.controllable) {
    json["capabilities"].push_back("clientPublish");
    json["capabilities"].push_back("services");
    json["supportedEncodings"].push_back("json");
  }
  json["metadata"] = Json::object();
  for (const auto& [name, text] : greeting.facts) json["metadata"][name] = text;
  json["sessionId"] = greeting.run;
  return json.dump();
}

std::string advertise_text(const std::vector<Channel>& channels) {
  Json json;
  json["op"] = "advertise";
  json["channels"] = Json::array();
  for (const Channel& one : channels) {
    json["channels"].push_back(
        {{"id", one.id},
         {"topic", one.topic},
         {"encoding", one.encoding},
         {"schemaName", one.schema_name},
         {"schema", one.schema},
         {"schemaEncoding", one.encoding == "json" ? "jsonschema" : one.encoding}});
  }
  return json.dump();
}

std::string services_text(const std::vector<Service>& services) {
  const auto shape = [](const char* name) {
    return Json{{"encoding", "json"},
                {"schemaName", name},
                {"schemaEncoding", "jsonschema"},
                {"schema", R"({"type":"object"})"}};
  };
  Json json;
  json["op"] = "advertiseServices";
  json["services"] = Json::array();
  for (const Service& one : services) {
    Json service;
    service["id"] = one.id;
    service["name"] = one.name;
    service["type"] = one.name;
    service["request"] = shape("palp.monitor.Request");
    service["response"] = shape("palp.monitor.Answer");
    json["services"].push_back(std::move(service));
  }
  return json.dump();
}

std::string status_text(Level level, std::string_view sentence) {
  return Json{{"op", "status"}, {"level", static_cast<unsigned>(level)}, {"message", sentence}}
      .dump();
}

std::string call_failure_text(std::uint32_t service,
                              std::uint32_t call,
                              std::string_view sentence) {
  return Json{
      {"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", sentence}}
      .dump();
}

std::string message_bytes(std::uint32_t subscription,
                          std::uint64_t stamp,
                          std::span<const std::byte> payload) {
  std::string out(1, kMessage);
  append(out, subscription);
  append(out, stamp);
  for (const std::byte one : payload) out += static_cast<char>(one);
  return out;
}

std::string call_answer_bytes(std::uint32_t service, std::uint32_t call, std::string_view json) {
  constexpr std::string_view kEncoding = "json";
  std::string out(1, kAnswer);
  append(out, service);
  append(out, call);
  append(out, static_cast<std::uint32_t>(kEncoding.size()));
  out += kEncoding;
  out += json;
  return out;
}

bool is_shallow(std::string_view text) noexcept {
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kNestingMax) return false;
  }
  return true;
}

std::optional<ClientText> read_client_text(std::string_view text) {
  if (!is_shallow(text)) return std::nullopt;
  const Json json = Json::parse(text);
  const auto op = json.at_or_null("op").text();
  if (!op) return std::nullopt;
  ClientText out;
  if (*op == "subscribe") {
    out.op = ClientText::Op::Subscribe;
    read_subscriptions(json, out);
  } else if (*op == "unsubscribe") {
    out.op = ClientText::Op::Unsubscribe;
    read_ids(json, "subscriptionIds", out);
  } else if (*op == "advertise") {
    out.op = ClientText::Op::Advertise;
    read_publications(json, out);
  } else if (*op == "unadvertise") {
    out.op = ClientText::Op::Unadvertise;
    read_ids(json, "channelIds", out);
  }
  return out;
}

std::optional<ClientBytes> read_client_bytes(std::string_view bytes) {
  constexpr std::size_t kMessageHead = 5;
  constexpr std::size_t kCallHead = 13;
  ClientBytes out;
  if (bytes.size() >= kMessageHead && bytes[0] == kMessage) {
    out.id = number_at(bytes, 1);
    out.payload = bytes.substr(kMessageHead);
    return out;
  }
  if (bytes.size() < kCallHead || bytes[0] != kCall) return std::nullopt;
  out.call = true;
  out.id = number_at(bytes, 1);
  out.call_id = number_at(bytes, 5);
  const std::size_t encoding = number_at(bytes, 9);
  if (encoding > bytes.size() - kCallHead) return std::nullopt;
  out.encoding = bytes.substr(kCallHead, encoding);
  out.payload = bytes.substr(kCallHead + encoding);
  return out;
}

}  // namespace palp::monitor
