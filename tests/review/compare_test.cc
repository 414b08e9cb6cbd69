#include "review/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::review {
namespace {

using testing::HasSubstr;

TEST(CompareTest, SessionsStandSideBySide) {
  Compared mmt{.name = "one", .coupling = "mmt", .metrics = {}};
  mmt.metrics.force_peak = 0.5;
  Compared wave{.name = "two", .coupling = "wave", .metrics = {}};
  wave.metrics.unstable = true;
  const std::string text = comparison_text({mmt, wave});
  EXPECT_THAT(text, HasSubstr("coupling                                mmt           wave\n"));
  EXPECT_THAT(text, HasSubstr("stable                                  yes             no\n"));
  EXPECT_THAT(text, HasSubstr("force_peak_n                            0.5              0\n"));
  EXPECT_THAT(text, HasSubstr("drag_rms_n                                -              -\n"));
}

}  // namespace
}  // namespace palp::review
