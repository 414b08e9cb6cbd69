#include "study/journal.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(JournalTest, GrowsByLinesAndCutsOffWhatWasNeverFinished) {
  const test::PlannedFolder folder;
  const std::string path = folder.beside("lines");
  {
    auto journal = Journal::open(path);
    ASSERT_TRUE(journal);
    EXPECT_TRUE(journal->add("one\n"));
    EXPECT_TRUE(journal->add("two, but"));
  }
  auto journal = Journal::open(path);
  ASSERT_TRUE(journal);
  EXPECT_EQ(journal->text(), "one\ntwo, but");
  ASSERT_TRUE(journal->cut(4));
  EXPECT_TRUE(journal->add("two\n"));
  EXPECT_EQ(test::content_of(path), "one\ntwo\n");
  EXPECT_EQ(test::content_of(path + ".cut"), "two, but\n");  // nothing is lost
}

TEST(JournalTest, HasOneWriter) {
  const test::PlannedFolder folder;
  const std::string path = folder.beside("lines");
  {
    auto journal = Journal::open(path);
    ASSERT_TRUE(journal);
    const auto second = Journal::open(path);
    ASSERT_FALSE(second);
    EXPECT_TRUE(second.error().unreachable);
    EXPECT_TRUE(journal->add("one\n"));
  }
  // What the first one wrote is read by the next: nothing is read before the file is its own.
  EXPECT_EQ(Journal::open(path)->text(), "one\n");
}

TEST(JournalTest, NothingButAFileIsOne) {
  EXPECT_FALSE(Journal::open("/"));
  EXPECT_FALSE(Journal::open("/dev/null"));
  const test::PlannedFolder folder;
  ASSERT_EQ(::mkfifo(folder.beside("pipe").c_str(), 0600), 0);
  EXPECT_FALSE(Journal::open(folder.beside("pipe")));  // and does not wait for who writes
  std::filesystem::create_symlink(folder.beside("study.textproto"), folder.beside("link"));
  EXPECT_FALSE(Journal::open(folder.beside("link")));
}

TEST(JournalTest, WhatIsTheOwnersWasNeverAnybodysElse) {
  const test::PlannedFolder folder;
  const auto journal = Journal::open(folder.beside("key"), Readers::Owner);
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(folder.beside("key")).permissions(),
            perms::owner_read | perms::owner_write);
}

}  // namespace
}  // namespace palp::study
