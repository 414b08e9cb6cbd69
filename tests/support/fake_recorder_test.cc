#include "tests/support/fake_recorder.h"

#include <gtest/gtest.h>

namespace palp::test {
namespace {

TEST(FakeRecorderTest, KeepsEverythingInOrderAndSortsByType) {
  KeepingRecorder recorder;
  EXPECT_TRUE(recorder.record(Note{.at = {}, .code = 3, .detail = 0}));
  EXPECT_TRUE(recorder.record(Transition{}));
  EXPECT_TRUE(recorder.record(Note{.at = {}, .code = 5, .detail = 0}));
  ASSERT_EQ(recorder.records().size(), 3U);
  const auto notes = recorder.all<Note>();
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0].code, 3);
  EXPECT_EQ(notes[1].code, 5);
  EXPECT_EQ(recorder.all<Transition>().size(), 1U);
  EXPECT_TRUE(recorder.all<SiteTick>().empty());
}

TEST(FakeRecorderTest, RecordingIsNoViolation) {
  KeepingRecorder recorder;
  RealtimeGuard guard;
  for (int i = 0; i < 100; ++i) recorder.record(Note{});
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
}

TEST(FakeRecorderTest, NullTakesAndFullRefuses) {
  NullRecorder null;
  FullRecorder full;
  EXPECT_TRUE(null.record(Note{}));
  EXPECT_FALSE(full.record(Note{}));
}

}  // namespace
}  // namespace palp::test
