#include "netem/model/impairment.h"

#include <iomanip>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/netem/model/impairment_builders.h"
#include "tests/netem/model/impairment_generators.h"

namespace palp::netem {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ImpairmentTest, ReadsEveryWord) {
  const Impairment read = impaired(
      "delay 50ms 10ms 25% distribution normal floor 20% loss 5% loss burst 0.2/s 200ms "
      "loss gilbert-time 1s 20ms 90% 0.1% duplicate 5% blackout 12s 2s blackout 20s 500us "
      "order netem");
  EXPECT_EQ(read.delay,
            (DelayLaw{.mean = milliseconds{50},
                      .jitter = milliseconds{10},
                      .shape = DelayShape::Normal,
                      .floor = 0.2,
                      .correlation = 0.25,
                      .correlation_time = {},
                      .table = {},
                      .histogram = {}}));
  EXPECT_EQ(read.loss, (Chance{0.05, 0}));
  EXPECT_EQ(read.burst, (BurstLaw{0.2, milliseconds{200}}));
  EXPECT_EQ(read.gilbert, (GilbertLaw{seconds{1}, milliseconds{20}, 0.9, 0.001}));
  EXPECT_EQ(read.duplicate, (Chance{0.05, 0}));
  EXPECT_EQ(read.blackouts,
            (std::vector<Blackout>{{seconds{12}, seconds{2}}, {seconds{20}, microseconds{500}}}));
  EXPECT_EQ(read.order, Order::Netem);
}

TEST(ImpairmentTest, TakesTcsSpellingsOfUnits) {
  for (const char* words : {"delay 2ms",
                            "delay 2msec",
                            "delay 2MSECS",
                            "delay 2000us",
                            "delay 2e3us",
                            "delay 0.002s",
                            "delay .002sec",
                            "delay 2000000ns",
                            "\tdelay  2ms\n"}) {
    EXPECT_EQ(impaired(words).delay.mean, milliseconds{2}) << words;
  }
}

TEST(ImpairmentTest, NothingAndNoneAreAPerfectLink) {
  EXPECT_EQ(impaired(""), Impairment{});
  EXPECT_EQ(impaired(" "), Impairment{});
  EXPECT_EQ(impaired("none"), Impairment{});
  EXPECT_EQ(to_string(Impairment{}), "none");
}

TEST(ImpairmentTest, IsUniformWithOrderKeptUnlessToldOtherwise) {
  const Impairment read = impaired("delay 50ms 10ms");
  EXPECT_EQ(read.delay.shape, DelayShape::Uniform);
  EXPECT_EQ(read.order, Order::Keep);
  EXPECT_EQ(read, impaired("delay 50ms 10ms 0% distribution uniform order keep"));
}

TEST(ImpairmentTest, WritesTheLargestUnitThatFits) {
  EXPECT_EQ(to_string(impaired("delay 1500us 20us correlation-time 0.04s order netem")),
            "delay 1.5ms 20us correlation-time 40ms order netem");
  EXPECT_EQ(to_string(impaired("loss random 0.0125% blackout 12s 1ns")),
            "loss 0.0125% blackout 12s 0.001us");
  EXPECT_EQ(to_string(impaired("loss 100% duplicate 12.5%")), "loss 100% duplicate 12.5%");
}

RC_GTEST_PROP(ImpairmentTest, ReadsBackWhatItWrites, ()) {
  const Impairment asked = make_impairment(kTimeMax);
  const std::string words = to_string(asked);
  RC_LOG() << words << '\n';
  const auto read = parse_impairment(words);
  RC_ASSERT(read.has_value());
  RC_ASSERT(*read == asked);
}

RC_GTEST_PROP(ImpairmentTest, AnswersAnyTextWithAValueOrOneSentence, ()) {
  const auto words =
      *rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(std::vector<std::string>{
          "delay",     "loss",     "burst",        "random",  "gilbert-time",
          "duplicate", "blackout", "order",        "keep",    "free",
          "50ms",      "5%",       "0.2/s",        "-1ms",    "1e999s",
          "%",         "normal",   "distribution", "floor",   "correlation-time",
          "none",      "101%",     "state",        "gemodel", "rate",
          "slot",      "limit",    "reorder",      "gap",     "stall",
          "queue",     "codel",    "mtu",          "corrupt", "nan%",
          "\x80\xff",  "5",        "infms"}));
  std::string text;
  for (const std::string& word : words) text += word + " ";
  const auto read = parse_impairment(text);
  if (read) {
    RC_ASSERT(impaired(to_string(*read)) == *read);
  } else {
    RC_ASSERT(read.error().text.find('\n') == std::string::npos);
    RC_ASSERT(read.error().text.find(", expected ") != std::string::npos);
  }
}

struct Refusal {
  const char* words;
  int column;
  const char* found;
  const char* expected;
  // NOLINTNEXTLINE(readability-identifier-naming): GoogleTest's name
  friend void PrintTo(const Refusal& refusal, std::ostream* out) {
    *out << std::quoted(refusal.words);
  }
};

class ImpairmentRefusalTest : public ::testing::TestWithParam<Refusal> {};

TEST_P(ImpairmentRefusalTest, NamesColumnWordAndWhatWasExpected) {
  const auto read = parse_impairment(GetParam().words);
  ASSERT_FALSE(read.has_value());
  const std::string begin = "impairment, column " + std::to_string(GetParam().column) + ": found " +
                            GetParam().found + ", expected ";
  EXPECT_EQ(read.error().text.substr(0, begin.size()), begin) << read.error().text;
  EXPECT_NE(read.error().text.find(GetParam().expected, begin.size()), std::string::npos)
      << read.error().text;
}

INSTANTIATE_TEST_SUITE_P(
    Wrong,
    ImpairmentRefusalTest,
    ::testing::Values(
        Refusal{"dely 50ms", 1, "'dely'", "delay, loss, ecn, duplicate"},
        Refusal{"delay 50ms lose 5%", 12, "'lose'", "delay, loss"},
        Refusal{"delay", 6, "the end", "mean delay"},
        Refusal{"delay 50min", 7, "'50min'", "s, ms, us, ns"},
        Refusal{"delay 50 ms", 10, "'ms'", "delay, loss"},
        Refusal{"delay -5ms", 7, "'-5ms'", "from 0s"},
        Refusal{"delay 1000000.1s", 7, "'1000000.1s'", "to 1000000s"},
        Refusal{"delay nanms", 7, "'nanms'", "s, ms, us"},
        Refusal{"delay 5ms 1ms distribution no-such", 28, "'no-such'", "uniform, normal"},
        Refusal{"delay 0ms 5ms distribution gamma", 33, "the end", "above 0"},
        Refusal{"delay 5ms distribution normal", 30, "the end", "jitter"},
        Refusal{"delay 5ms correlation-time 1ms", 11, "'correlation-time'", "jitter"},
        Refusal{"delay 5ms 1ms 25% correlation-time 1ms", 19, "'correlation-time'", "one corr"},
        Refusal{"delay 5ms 1ms correlation-time 0ms", 32, "'0ms'", "above 0"},
        Refusal{"delay 5ms 1ms floor 2% floor 3%", 24, "'floor'", "only once"},
        Refusal{"delay 5ms delay 6ms", 11, "'delay'", "only once"},
        Refusal{"loss", 5, "the end", "random, state, gemodel, burst"},
        Refusal{"loss 100.1%", 6, "'100.1%'", "0% to 100%"},
        Refusal{"loss -1%", 6, "'-1%'", "0% to 100%"},
        Refusal{"loss 5% 25% 30%", 13, "'30%'", "delay, loss"},
        Refusal{"loss 5% loss random 6%", 14, "'random'", "only once"},
        Refusal{"loss burst 0.2 200ms", 12, "'0.2'", "0.2/s"},
        Refusal{"loss burst 0.2/s 0ms", 18, "'0ms'", "above 0"},
        Refusal{"loss burst 1e7/s 1ms", 12, "'1e7/s'", "1000000/s"},
        Refusal{"loss gilbert-time 1s 99us", 22, "'99us'", "at least 0.1ms"},
        Refusal{"duplicate maybe", 11, "'maybe'", "per cent"},
        Refusal{"blackout 12s", 13, "the end", "length"},
        Refusal{"blackout 12s 0s", 14, "'0s'", "above 0"},
        Refusal{"order sorted", 7, "'sorted'", "keep, netem or swap"},
        Refusal{"none delay 5ms", 6, "'delay'", "nothing"}));

TEST(ImpairmentTest, AcceptsTheBordersItNames) {
  EXPECT_TRUE(parse_impairment("delay 1000000s 0us"));
  EXPECT_TRUE(parse_impairment("loss 100% duplicate 0%"));
  EXPECT_TRUE(parse_impairment("loss gilbert-time 100us 0.1ms"));
  EXPECT_TRUE(parse_impairment("loss burst 1000000/s 1ns"));
}

TEST(ImpairmentTest, RefusesOneBlackoutTooMany) {
  std::string words;
  for (std::size_t i = 0; i < kBlackoutsMax; ++i) words += "blackout 1s 1s ";
  EXPECT_TRUE(parse_impairment(words));
  EXPECT_FALSE(parse_impairment(words + "blackout 1s 1s"));
}

TEST(ImpairmentTest, PlainLawHasHalfTheRoundTripAndReordersOnlyWithJitter) {
  const auto still = impairment_from_rtt(milliseconds{100}, {}, 0.05);
  ASSERT_TRUE(still);
  EXPECT_EQ(*still, impaired("delay 50ms loss 5%"));
  const auto jittery = impairment_from_rtt(milliseconds{100}, milliseconds{15}, 0);
  ASSERT_TRUE(jittery);
  EXPECT_EQ(*jittery, impaired("delay 50ms 15ms distribution normal floor 20% order netem"));
  EXPECT_EQ(*impairment_from_delay(milliseconds{50}, milliseconds{15}, 0), *jittery);
}

TEST(ImpairmentTest, PlainLawRefusesWhatCannotBe) {
  EXPECT_FALSE(impairment_from_delay(milliseconds{-1}, {}, 0));
  EXPECT_FALSE(impairment_from_delay({}, milliseconds{-1}, 0));
  EXPECT_FALSE(impairment_from_delay({}, {}, 1.01));
  EXPECT_FALSE(impairment_from_delay({}, {}, -0.01));
  EXPECT_FALSE(impairment_from_delay({}, {}, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(impairment_from_delay({}, {}, 1));
}

}  // namespace
}  // namespace palp::netem
