#include "common/io/process/child_output.h"

#include <gtest/gtest.h>

namespace palp::io {
namespace {

TEST(ChildOutputTest, IsWhatTheProgramMadeOfAnyLengthOfInput) {
  const std::string input(3'000'000, 'x');
  const auto output = child_output({"tr", "x", "y"}, input);
  ASSERT_TRUE(output) << output.error().text;
  EXPECT_EQ(*output, std::string(3'000'000, 'y'));
}

TEST(ChildOutputTest, AProgramThatEndsBadlyIsQuotedWithItsLastLine) {
  const auto output = child_output({"sh", "-c", "echo first >&2; echo last >&2; exit 3"}, "");
  ASSERT_FALSE(output);
  EXPECT_EQ(output.error().text, "sh: last");
  EXPECT_FALSE(output.error().unreachable);
}

TEST(ChildOutputTest, AProgramThatIsNotThereIsNotReached) {
  const auto output = child_output({"/no/such/program"}, "");
  ASSERT_FALSE(output);
  EXPECT_EQ(output.error().text, "/no/such/program cannot be started: no such file or directory");
  EXPECT_TRUE(output.error().unreachable);
}

}  // namespace
}  // namespace palp::io
