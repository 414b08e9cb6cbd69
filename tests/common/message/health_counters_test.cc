#include "common/message/health_counters.h"

#include <gmock/gmock.h>

namespace palp::message {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(HealthCountersTest, RefusalsAreNamedByTheirReason) {
  const LinkHealth health{.malformed = 1, .foreign = 2, .replayed = 3, .too_old = 4, .forged = 5};
  EXPECT_THAT(refusals_of(health),
              ElementsAre(Pair("malformed", 1U),
                          Pair("foreign", 2U),
                          Pair("replayed", 3U),
                          Pair("too_old", 4U),
                          Pair("forged", 5U)));
}

TEST(HealthCountersTest, CountersAreAllOthers) {
  const LinkHealth health{.sent = 7, .unsent = 9, .malformed = 1};
  const Counters counters = counters_of(health);
  EXPECT_EQ(counters.size(), 9U);
  EXPECT_EQ(counters.front(), (std::pair<std::string_view, std::uint64_t>{"sent", 7}));
  EXPECT_EQ(counters.back(), (std::pair<std::string_view, std::uint64_t>{"unsent", 9}));
}

}  // namespace
}  // namespace palp::message
