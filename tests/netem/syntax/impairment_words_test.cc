#include "netem/syntax/impairment_words.h"

#include <gtest/gtest.h>

#include "tests/netem/model/impairment_builders.h"

namespace palp::netem {
namespace {

TEST(WordReaderTest, ReadsBareNumbersAsTcDoes) {
  EXPECT_EQ(impaired("delay 100").delay.mean, std::chrono::microseconds{100});
  EXPECT_EQ(impaired("loss 5").loss.share, 0.05);
  EXPECT_EQ(impaired("rate 8000").rate.bytes_per_s, 1000U);
  EXPECT_EQ(impaired("limit 10k").limit, 10'240U);
}

TEST(WordReaderTest, ReadsTcsRatesInBitsAndBytes) {
  EXPECT_EQ(impaired("rate 2mbit").rate.bytes_per_s, 250'000U);
  EXPECT_EQ(impaired("rate 250kbps").rate.bytes_per_s, 250'000U);
  EXPECT_EQ(impaired("rate 1MiBit").rate.bytes_per_s, 131'072U);
  EXPECT_EQ(impaired("rate 2mbit -4 48 5").rate,
            (RateLaw{.bytes_per_s = 250'000, .overhead = -4, .cell = 48, .cell_overhead = 5}));
}

TEST(WordReaderTest, TakesTheBeginningOfAClauseForItAsTcDoes) {
  const auto read = parse_impairment("del 5ms dup 1% corr 2% reo 3% lim 9", Mode::Netem61);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->duplicate.share, 0.01);
  EXPECT_EQ(read->corrupt.share, 0.02);
  EXPECT_EQ(read->reorder.gap, 1U);
  EXPECT_EQ(read->limit, 9U);
  EXPECT_EQ(impaired("latency 5ms drop 1%"), impaired("delay 5ms loss 1%"));
}

TEST(WordReaderTest, TakesEveryStringOfTcsManual) {
  for (const char* words : {"delay 100ms 10ms 25%",
                            "delay 100ms 20ms distribution normal",
                            "loss random 0.3% 25%",
                            "loss state 1% 30% 10% 90% 0.5%",
                            "loss gemodel 1% 10% 70% 0.1%",
                            "loss 1% ecn",
                            "duplicate 1% 5%",
                            "corrupt 0.1% 5%",
                            "delay 10ms reorder 25% 50% gap 5",
                            "gap 5 delay 10ms reorder 50%",
                            "rate 5kbit 20 100 5",
                            "slot 20us",
                            "slot 800us 1000us packets 4 bytes 64k",
                            "slot distribution pareto 250ms 50ms packets 2",
                            "distribution pareto delay 5ms 1ms"}) {
    EXPECT_TRUE(parse_impairment(words, Mode::Netem61)) << words;
    EXPECT_TRUE(parse_impairment(words, Mode::Exact)) << words;
  }
}

TEST(WordReaderTest, ModeNetem61HasNoWordsOfOurs) {
  for (const char* words : {"order keep",
                            "blackout 1s 1s",
                            "loss burst 1/s 1ms",
                            "stall 1/s 1ms",
                            "delay 5ms 1ms correlation-time 5ms",
                            "delay 5ms 1ms distribution gamma",
                            "loss 1% loss state 1%"}) {
    EXPECT_FALSE(parse_impairment(words, Mode::Netem61)) << words;
  }
}

TEST(WordReaderTest, TheModeMayStandFirst) {
  const auto read = parse_impairment("mode netem-6.1 delay 5ms 1ms");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mode, Mode::Netem61);
  EXPECT_EQ(to_string(*read), "mode netem-6.1 delay 5ms 1ms");
  EXPECT_EQ(impaired(to_string(*read)), *read);
  EXPECT_FALSE(parse_impairment("mode netem-6.2 delay 5ms"));
  EXPECT_FALSE(parse_impairment("delay 5ms mode exact"));
}

TEST(WordReaderTest, RefusesWhatDoesNotGoTogetherAtItsColumn) {
  for (const auto& [words, begin] : std::initializer_list<std::pair<const char*, const char*>>{
           {"reorder 25%", "impairment, column 12: found the end, expected a delay"},
           {"ecn", "impairment, column 4: found the end, expected a loss model"},
           {"queue packets 5", "impairment, column 16: found the end, expected a rate"},
           {"slot 5ms 2ms", "impairment, column 6: found '5ms'"},
           {"rate 0mbit", "impairment, column 6: found '0mbit'"},
           {"loss state 60% 50% 60%", "impairment, column 6: found 'state', expected p31 + p32"},
           {"trace no-such-file.csv", "impairment, column 7: no file 'no-such-file.csv'"},
           {"delay 5ms mtu 10", "impairment, column 15: found '10'"}}) {
    const auto read = parse_impairment(words);
    ASSERT_FALSE(read) << words;
    EXPECT_EQ(read.error().text.rfind(begin, 0), 0U) << read.error().text;
  }
}

}  // namespace
}  // namespace palp::netem
