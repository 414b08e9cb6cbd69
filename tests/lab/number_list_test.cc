#include "lab/number_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::lab {
namespace {

TEST(NumberListTest, TakesNumbersWithCommasBetween) {
  EXPECT_THAT(parse_numbers("--x", "5,0.5,1e1", 0, 10).value(), testing::ElementsAre(5, 0.5, 10));
}

TEST(NumberListTest, RefusesWhatIsNoneAndWhatIsOutOfRange) {
  for (const char* text : {"", "5,", "5;6", "11", "-1", "nan", "5,x"}) {
    const auto refused = parse_numbers("--x", text, 0, 10);
    ASSERT_FALSE(refused) << text;
    EXPECT_THAT(refused.error().text, testing::HasSubstr("expected numbers from 0 to 10"));
  }
}

}  // namespace
}  // namespace palp::lab
