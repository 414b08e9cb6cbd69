#include "monitor/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/config/json.h"

namespace palp::monitor {
namespace {

using config::Json;
using testing::ElementsAre;
using namespace std::string_literals;

TEST(ProtocolTest, ATopicsSchemaIsThatOfTheSessionFile) {
  // RFC 4648, section 10.
  const auto encoded = [](std::string_view text) {
    record::TopicFormat format{
        .topic = record::Topic::Event, .name = "a", .schema = "b", .descriptors = {}};
    for (const char c : text) format.descriptors.push_back(static_cast<std::byte>(c));
    return channel_of(format).schema;
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(ProtocolTest, OfASubprotocolsListTheFirstThatIsOursIsTaken) {
  EXPECT_EQ(subprotocol_of("foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(subprotocol_of("foxglove.websocket.v1, foxglove.sdk.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(subprotocol_of("mqtt,\tfoxglove.sdk.v1 "), "foxglove.sdk.v1");
  for (const char* none : {"", " ", ",, ,", "foxglove.sdk.v10", "my.foxglove.sdk.v1", "foxglove"}) {
    EXPECT_EQ(subprotocol_of(none), "") << none;
  }
}

TEST(ProtocolTest, AMessageIsLittleEndianBehindItsSubscription) {
  const std::array payload{std::byte{7}, std::byte{8}};
  EXPECT_EQ(message_bytes(0x01020304, 0x1122334455667788, payload),
            "\x01\x04\x03\x02\x01\x88\x77\x66\x55\x44\x33\x22\x11\x07\x08"s);
}

TEST(ProtocolTest, AnAnswerNamesItsCall) {
  EXPECT_EQ(call_answer_bytes(2, 3, "{}"), "\x03\x02\0\0\0\x03\0\0\0\x04\0\0\0json{}"s);
}

TEST(ProtocolTest, SubscriptionsAreRead) {
  const auto text = read_client_text(
      R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":5},{"id":-1,"channelId":5},7]})");
  ASSERT_TRUE(text);
  EXPECT_EQ(text->op, ClientText::Op::Subscribe);
  ASSERT_EQ(text->subscriptions.size(), 1U) << "what makes no sense is left out";
  EXPECT_EQ(text->subscriptions[0].channel, 5U);
  const auto ends = read_client_text(R"({"op":"unsubscribe","subscriptionIds":[1,2,1e99,"3"]})");
  ASSERT_TRUE(ends);
  EXPECT_THAT(ends->ids, ElementsAre(1, 2));
}

TEST(ProtocolTest, WhatIsNoTextOfTheProtocolIsNone) {
  EXPECT_FALSE(read_client_text(""));
  EXPECT_FALSE(read_client_text("[]"));
  EXPECT_FALSE(read_client_text("{\"op\":7}"));
  const std::string deep = std::string(20, '[') + std::string(20, ']');
  EXPECT_FALSE(read_client_text("{\"op\":\"subscribe\",\"a\":" + deep + "}"))
      << "nor is what nests without end";
  EXPECT_EQ(read_client_text(R"({"op":"fetchAsset"})")->op, ClientText::Op::Other);
}

TEST(ProtocolTest, ACallIsReadWithinItsBytes) {
  const std::string bytes = "\x02\x05\0\0\0\x09\0\0\0\x04\0\0\0json{}"s;
  const auto call = read_client_bytes(bytes);
  ASSERT_TRUE(call);
  EXPECT_TRUE(call->call);
  EXPECT_EQ(call->id, 5U);
  EXPECT_EQ(call->call_id, 9U);
  EXPECT_EQ(call->encoding, "json");
  EXPECT_EQ(call->payload, "{}");
  EXPECT_FALSE(read_client_bytes("\x02\x05\0\0\0\x09\0\0\0\xff\xff\xff\xffjson{}"s))
      << "a length that lies";
}

RC_GTEST_PROP(ProtocolTest, AnyBytesAreReadOrRefused, (const std::string& any)) {
  (void)read_client_text(any);
  for (const char kind : {'\x01', '\x02', '\x03'}) {
    const std::string bytes = kind + any;
    const auto read = read_client_bytes(bytes);
    if (read) RC_ASSERT(read->payload.size() + 5 <= bytes.size());
  }
}

RC_GTEST_PROP(ProtocolTest, ASentenceOfAnyBytesStaysWithinItsText, (const std::string& any)) {
  const Json json = Json::parse(status_text(Level::Warning, any));
  RC_ASSERT(json.at_or_null("op").text() == std::optional<std::string_view>{"status"});
}

TEST(ProtocolTest, AGreetingTellsWhatAClientMayDo) {
  const Json looks = Json::parse(greeting_text({.name = "n", .run = "r", .controllable = false}));
  EXPECT_TRUE(looks["capabilities"].parts().empty());
  const Json steers = Json::parse(
      greeting_text({.name = "n", .run = "r", .controllable = true, .facts = {{"a", "b"}}}));
  EXPECT_EQ(steers["capabilities"].parts().size(), 2U);
  EXPECT_EQ(steers["metadata"]["a"].text(), "b");
  EXPECT_EQ(steers["sessionId"].text(), "r");
}

}  // namespace
}  // namespace palp::monitor
