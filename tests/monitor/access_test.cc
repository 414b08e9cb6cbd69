#include "monitor/access.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::monitor {
namespace {

using std::chrono_literals::operator""s;

const std::string kView(32, 'a');
const std::string kControl(32, 'b');

Access access() { return Access{{.view = kView, .control = kControl}, {"http://tools.ward:9"}}; }

RC_GTEST_PROP(SameSecretTest, SaysWhatEqualitySays, (const std::string& a, const std::string& b)) {
  RC_ASSERT(same_secret(a, b) == (a == b && !b.empty()));
  RC_ASSERT(same_secret(a, a) == !a.empty());
}

TEST(SameSecretTest, NothingIsNoSecret) {
  EXPECT_FALSE(same_secret("", ""));
  EXPECT_FALSE(same_secret(kView.substr(1), kView));
  EXPECT_FALSE(same_secret(kView + "a", kView));
}

TEST(TokenInTest, IsTheWholeValueOfItsNameAlone) {
  EXPECT_EQ(token_in("/?token=abc"), "abc");
  EXPECT_EQ(token_in("/?name=x&token=abc&more=y"), "abc");
  for (const char* none : {"", "/", "/token=abc", "/?", "/?mytoken=abc", "/?token"}) {
    EXPECT_EQ(token_in(none), "") << none;
  }
}

TEST(AccessTest, OnlyLoopbackNamesAreOurs) {
  for (const char* good : {"127.0.0.1:8080", "localhost:1", "[::1]:65535", "localhost"}) {
    EXPECT_TRUE(Access::host_allowed(good)) << good;
  }
  for (const char* bad : {"",
                          "palp.attacker.org:8080",
                          "localhost.attacker.org:8080",
                          "127.0.0.1.attacker.org",
                          "127.0.0.1:8080.attacker.org",
                          "localhost:",
                          "localhost:123456",
                          "attacker.org@localhost:8080",
                          "127.0.0.2:8080",
                          "::1",
                          "0.0.0.0:8080"}) {
    EXPECT_FALSE(Access::host_allowed(bad)) << bad;
  }
}

TEST(AccessTest, OnlyOurPageAndListedOnesMayAsk) {
  const Access one = access();
  EXPECT_TRUE(one.origin_allowed("", "localhost:8080")) << "no browser";
  EXPECT_TRUE(one.origin_allowed("http://localhost:8080", "localhost:8080"));
  EXPECT_TRUE(one.origin_allowed("http://tools.ward:9", "localhost:8080"));
  for (const char* bad : {"http://localhost:8081",
                          "https://localhost:8080",
                          "http://attacker.org",
                          "null",
                          "http://localhost:8080.attacker.org",
                          "http://tools.ward"}) {
    EXPECT_FALSE(one.origin_allowed(bad, "localhost:8080")) << bad;
  }
}

TEST(AccessTest, ATokenGivesItsRightAndNoOtherTextDoes) {
  Access one = access();
  EXPECT_EQ(one.right_of(kView, {}), Right::View);
  EXPECT_EQ(one.right_of(kControl, {}), Right::Control);
  EXPECT_EQ(one.right_of("", {}), Right::None);
  EXPECT_EQ(one.right_of(kView + kControl, {}), Right::None);
}

TEST(AccessTest, WithoutAControlTokenNobodyControls) {
  Access one{{.view = kView, .control = ""}, {}};
  EXPECT_EQ(one.right_of("", {}), Right::None);
  EXPECT_EQ(one.right_of(kControl, {}), Right::None);
}

TEST(AccessTest, GuessesAreAnsweredFiveTimesAMinuteAndLockNobodyOut) {
  Access one = access();
  const TimePoint start{100s};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(one.right_of("guess", start), Right::None);
    EXPECT_FALSE(one.weary(start)) << i;
  }
  EXPECT_EQ(one.right_of("guess", start + 1s), Right::None);
  EXPECT_TRUE(one.weary(start + 1s));
  EXPECT_EQ(one.right_of(kControl, start + 1s), Right::Control);
  EXPECT_FALSE(one.weary(start + 60s)) << "the minute is over";
}

}  // namespace
}  // namespace palp::monitor
