#include "study/journal.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(JournalTest, GrowsByLinesAndCutsOffWhatWasNeverFinished) {
  const test::PlannedFolder folder;
  const std::string path = folder.beside("lines");
  {
    auto journal = Journal::open(path, 0);
    ASSERT_TRUE(journal);
    EXPECT_TRUE(journal->add("one\n"));
    EXPECT_TRUE(journal->add("tw"));
  }
  auto journal = Journal::open(path, 4);
  ASSERT_TRUE(journal);
  EXPECT_TRUE(journal->add("two\n"));
  EXPECT_EQ(test::content_of(path), "one\ntwo\n");
}

TEST(JournalTest, HasOneWriter) {
  const test::PlannedFolder folder;
  const std::string path = folder.beside("lines");
  {
    const auto journal = Journal::open(path, 0);
    ASSERT_TRUE(journal);
    const auto second = Journal::open(path, 0);
    ASSERT_FALSE(second);
    EXPECT_TRUE(second.error().unreachable);
  }
  EXPECT_TRUE(Journal::open(path, 0));
}

TEST(JournalTest, AFolderIsNone) { EXPECT_FALSE(Journal::open("/", 0)); }

}  // namespace
}  // namespace palp::study
