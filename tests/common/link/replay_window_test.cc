#include "common/link/replay_window.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::link {
namespace {

using Verdict = ReplayWindow::Verdict;

/// The same by a set that forgets nothing.
class NaiveWindow {
 public:
  [[nodiscard]] Verdict judge(std::uint64_t number) const {
    if (!seen_.empty() && number + ReplayWindow::kSize <= *seen_.rbegin()) return Verdict::TooOld;
    return seen_.contains(number) ? Verdict::Seen : Verdict::New;
  }
  void mark(std::uint64_t number) { seen_.insert(number); }
  [[nodiscard]] std::uint64_t missing() const {
    return seen_.empty() ? 0 : *seen_.rbegin() + 1 - seen_.size();
  }
  [[nodiscard]] std::uint32_t before_newest() const {
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < 32 && !seen_.empty(); ++k) {
      if (*seen_.rbegin() > k && seen_.contains(*seen_.rbegin() - 1 - k)) bits |= 1U << k;
    }
    return bits;
  }

 private:
  std::set<std::uint64_t> seen_;
};

RC_GTEST_PROP(ReplayWindowTest, AgreesWithASet, ()) {
  const auto jumps = *rc::gen::container<std::vector<std::int64_t>>(
      rc::gen::oneOf(rc::gen::inRange<std::int64_t>(-40, 40),
                     rc::gen::inRange<std::int64_t>(-1100, 1100),
                     rc::gen::inRange<std::int64_t>(0, 1LL << 40U)));
  ReplayWindow window;
  NaiveWindow naive;
  std::int64_t at = 0;
  for (const std::int64_t jump : jumps) {
    at = std::max<std::int64_t>(0, at + jump);
    const auto number = static_cast<std::uint64_t>(at);
    RC_ASSERT(window.judge(number) == naive.judge(number));
    if (window.judge(number) == Verdict::New) {
      window.mark(number);
      naive.mark(number);
    }
    RC_ASSERT(window.missing() == naive.missing());
    RC_ASSERT(window.before_newest() == naive.before_newest());
  }
}

TEST(ReplayWindowTest, KnowsNothingAtFirst) {
  const ReplayWindow window;
  EXPECT_EQ(window.judge(0), Verdict::New);
  EXPECT_EQ(window.judge(~0ULL), Verdict::New);
  EXPECT_EQ(window.missing(), 0U);
}

TEST(ReplayWindowTest, LookingDoesNotMark) {
  ReplayWindow window;
  EXPECT_EQ(window.judge(5), Verdict::New);
  EXPECT_EQ(window.judge(5), Verdict::New);
  window.mark(5);
  EXPECT_EQ(window.judge(5), Verdict::Seen);
}

TEST(ReplayWindowTest, ReachesBackExactly1024Numbers) {
  ReplayWindow window;
  window.mark(5000);
  EXPECT_EQ(window.judge(5000 - 1023), Verdict::New);
  EXPECT_EQ(window.judge(5000 - 1024), Verdict::TooOld);
}

TEST(ReplayWindowTest, LateNumbersLeaveTheMissing) {
  ReplayWindow window;
  window.mark(0);
  window.mark(4);
  EXPECT_EQ(window.missing(), 3U);
  window.mark(2);
  EXPECT_EQ(window.missing(), 2U);
  EXPECT_EQ(window.before_newest(), 0b1010U);
}

}  // namespace
}  // namespace palp::link
