#include "patient_site/sensor_check.h"

#include <sstream>

#include <gtest/gtest.h>

#include "tests/common/io/device/fake_registers.h"

namespace palp::patient {
namespace {

/// A sensor of 100 Hz in virtual time; after the second answer it feels `loaded`, after the third
/// `afterwards`.
struct SensorWorld {
  Result<SensorFound> check(const std::string& answers) {
    std::istringstream in{answers};
    site_program::Dialogue talk{in, out};
    const auto step = [&] {
      clock.at += std::chrono::milliseconds{10};
      SensorFeeling one;
      one.ready = ready;
      one.trouble = trouble;
      one.number = ++number;
      one.zero = 2;
      const auto given = in.eof() ? answers.size() : static_cast<std::size_t>(in.tellg());
      const auto lines =
          std::count(answers.begin(), answers.begin() + static_cast<std::ptrdiff_t>(given), '\n');
      one.force = (lines == 2  ? loaded
                   : lines > 2 ? afterwards
                               : 0) +
                  (number % 2 == 0 ? 0.01 : -0.01);
      return one;
    };
    return check_sensor(step, clock, talk);
  }
  TestClock clock;
  std::ostringstream out;
  bool ready{true};
  std::string trouble;
  double loaded{5};
  double afterwards{};
  std::uint64_t number{};
};

TEST(SensorCheckTest, AKnownWeightGivesDirectionAndScale) {
  SensorWorld good;
  const auto same = good.check("\n5\n\n");
  ASSERT_TRUE(same) << same.error().text;
  EXPECT_EQ(same->scale, 1);
  EXPECT_NEAR(same->noise, 0.01, 1e-3);
  EXPECT_NEAR(same->rate, 100, 2);
  EXPECT_EQ(same->zero, 2);
  SensorWorld turned;
  turned.loaded = -2.5;
  const auto found = turned.check("\n5\n\n");
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_NEAR(found->scale, -2, 1e-3);
}

TEST(SensorCheckTest, WhatIsWrongWithItIsTold) {
  SensorWorld deaf;
  deaf.loaded = 0;
  EXPECT_EQ(deaf.check("\n5\n\n").error().text, "it did not feel the weight");
  SensorWorld sticky;
  sticky.afterwards = 1;
  EXPECT_EQ(sticky.check("\n5\n\n").error().text, "it does not come back to 0");
  SensorWorld broken;
  broken.ready = false;
  broken.trouble = "the reading is stuck";
  EXPECT_EQ(broken.check("\n5\n\n").error().text, "the reading is stuck");
  SensorWorld absent;
  absent.ready = false;
  EXPECT_EQ(absent.check("\n").error().text, "it is not ready after 10 s");
  EXPECT_EQ(SensorWorld{}.check("\n").error().text, "nobody answered: the check was left");
}

}  // namespace
}  // namespace palp::patient
