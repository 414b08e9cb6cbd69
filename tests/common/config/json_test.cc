#include "common/config/json.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck/gtest.h>

namespace palp::config {
namespace {

using Library = nlohmann::ordered_json;

/// The same value, put together with the same words.
template <class Value>
Value some_report(double real, std::int64_t whole, const std::string& text) {
  Value out;
  out["schema"] = "palp.test/1";
  out["real"] = real;
  out["whole"] = whole;
  out["natural"] = std::uint64_t{18'446'744'073'709'551'615U};
  out["text"] = text;
  out["truth"] = true;
  out["nothing"] = nullptr;
  out["range"] = {real, real / 3};
  out["member"] = {{"a", real}, {"b", nullptr}};
  out["list"] = Value::array();
  out["list"].push_back({{"a", 1}, {"b", text}});
  out["none"] = Value::array();
  out["empty"] = Value::object();
  out["texts"] = std::vector<std::string>{text, "b"};
  out["deep"]["er"][2] = real;
  out["real"] = real / 7;  // stays where it was
  Value more;
  more["whole"] = 1;
  more["last"] = 2;
  out.update(more);
  return out;
}

std::string text_of(const Library& json, int indent) {
  return json.dump(indent, ' ', false, Library::error_handler_t::replace);
}

RC_GTEST_PROP(Json, WritesWhatTheLibraryWrites, (double real, std::int64_t whole)) {
  const auto text = *rc::gen::arbitrary<std::string>();
  for (const int indent : {-1, 2}) {
    RC_ASSERT(some_report<Json>(real, whole, text).dump(indent) ==
              text_of(some_report<Library>(real, whole, text), indent));
  }
}

RC_GTEST_PROP(Json, ReadsWhatItWrote, (double real, std::int64_t whole)) {
  const std::string written = some_report<Json>(real, whole, "\xff \"quoted\"").dump(2);
  RC_ASSERT(Json::parse(written).dump(2) == written);
}

TEST(Json, NumbersThatAreNoneAreNull) {
  EXPECT_EQ(Json(std::nan("")).dump(), "null");
  EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).dump(), "null");
}

TEST(Json, WhatIsNoJsonReadsAsNull) {
  EXPECT_TRUE(Json::parse("{\"a\":").is_null());
  EXPECT_TRUE(Json::parse("").is_null());
}

TEST(Json, KnowsWhatItHolds) {
  const Json json = Json::parse(R"({"a": 3, "b": -3, "c": {}})");
  EXPECT_TRUE(json.is_object());
  EXPECT_TRUE(json.contains("a"));
  EXPECT_FALSE(json.contains("d"));
  EXPECT_TRUE(json["a"].is_unsigned());
  EXPECT_FALSE(json["b"].is_unsigned());
  EXPECT_TRUE(json["c"].is_object());
}

TEST(Json, GivesWhatItHoldsAndNothingElse) {
  const Json json = Json::parse(R"({"a": 3, "b": -3.5, "c": "text", "d": [1, 2], "e": true})");
  EXPECT_EQ(json["a"].number(), 3);
  EXPECT_EQ(json["b"].number(), -3.5);
  EXPECT_EQ(json["c"].text(), "text");
  EXPECT_EQ(json["d"].parts().size(), 2U);
  EXPECT_EQ(json["e"].truth(), true);
  EXPECT_FALSE(json["c"].number());
  EXPECT_FALSE(json["a"].text());
  EXPECT_FALSE(json["a"].truth());
  EXPECT_TRUE(json["a"].parts().empty());
  EXPECT_EQ(json.names().size(), 5U);
  EXPECT_TRUE(json["a"].names().empty());
  EXPECT_TRUE(json.at_or_null("f").is_null());
  EXPECT_TRUE(json["a"].at_or_null("f").is_null());
}

}  // namespace
}  // namespace palp::config
