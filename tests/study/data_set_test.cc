#include "study/data_set.h"

#include <gtest/gtest.h>

#include "common/config/json.h"
#include "study/schedule.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(DataSetTest, NamesAreThoseOfBids) {
  EXPECT_EQ(participant_id(0), "sub-01");
  EXPECT_EQ(participant_id(98), "sub-99");
  EXPECT_EQ(participant_id(99), "sub-100");
  EXPECT_EQ(DataSet{"d"}.trials("sub-01", "bias", 2),
            "d/sub-01/ses-01/beh/sub-01_ses-01_task-bias_run-02_beh.tsv");
}

// FIPS 180-4, example "abc".
TEST(FingerprintTest, IsSha256) {
  EXPECT_EQ(fingerprint("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(DataSetTest, AStudyIsRegisteredUntilSomethingIsChanged) {
  const test::PlannedFolder folder;
  EXPECT_TRUE(open_study(folder.folder())->registered);
  const std::string study = folder.folder() + "/code/study.textproto";
  const std::string schedule = folder.folder() + "/code/schedule.json";
  const std::string text = test::content_of(study);
  std::ofstream{study} << text << "# later\n";
  EXPECT_FALSE(open_study(folder.folder())->registered);
  std::ofstream{study} << text;
  EXPECT_TRUE(open_study(folder.folder())->registered);
  std::ofstream{schedule, std::ios::app} << " ";
  const auto changed = open_study(folder.folder());
  EXPECT_FALSE(changed->registered);
  EXPECT_NE(changed->why_not.find("schedule"), std::string::npos);
}

TEST(DataSetTest, ListsWhoIsThere) {
  const test::PlannedFolder folder;
  (void)folder.run(test::PlannedFolder::formula(), 2);
  EXPECT_EQ(test::content_of(folder.folder() + "/participants.tsv"),
            "participant_id\tkind\nsub-02\tsimulated\n");
  const auto rows = read_rows(*open_study(folder.folder()));
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_EQ((*rows)[0].id, "sub-02");
  EXPECT_GE((*rows)[0].rows.size(), 24U);
}

TEST(DataSetTest, KeepsTheColumnsThatSomebodyAdded) {
  const test::PlannedFolder folder;
  (void)folder.run(test::PlannedFolder::formula(), 2);
  const std::string list = folder.folder() + "/participants.tsv";
  std::ofstream{list} << "participant_id\tkind\tage_range\nsub-02\tsimulated\t30-39\n";
  (void)folder.run(test::PlannedFolder::formula(), 1);
  EXPECT_EQ(test::content_of(list),
            "participant_id\tkind\tage_range\nsub-01\tsimulated\tn/a\n"
            "sub-02\tsimulated\t30-39\n");
}

TEST(DataSetTest, ConditionsComeInTheOrderOfTheirLetters) {
  const test::PlannedFolder folder;
  const auto key = config::Json::parse(test::content_of(folder.folder() + "/code/key.json"));
  const auto planned = *open_study(folder.folder());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(key["letters"][condition_code(i)].text(), planned.study.conditions[i].name);
  }
  EXPECT_NE(planned.study.conditions[0].name, test::small_study().conditions[0].name);
}

TEST(DataSetTest, WithoutTheKeyNothingIsOpened) {
  const test::PlannedFolder folder;
  const std::string key = folder.folder() + "/code/key.json";
  const std::string text = test::content_of(key);
  std::filesystem::remove(key);
  const auto planned = open_study(folder.folder());
  ASSERT_FALSE(planned);
  EXPECT_TRUE(planned.error().unreachable);
  EXPECT_NE(planned.error().text.find("who planned the study has the key"), std::string::npos);
  std::ofstream{key} << text << " ";
  const auto changed = open_study(folder.folder());
  ASSERT_TRUE(changed);
  EXPECT_FALSE(changed->registered);
  EXPECT_NE(changed->why_not.find("key of the letters"), std::string::npos) << changed->why_not;
}

TEST(DataSetTest, WhatCannotBeReadIsNotTakenForNothing) {
  EXPECT_FALSE(DataSet{"/nowhere"}.participants());
  const test::PlannedFolder folder;
  EXPECT_FALSE(*read_if_there(folder.beside("nothing")));
  EXPECT_EQ(**read_if_there(folder.beside("study.textproto")), test::kStudyText);
  EXPECT_FALSE(read_if_there(folder.folder()));
  std::filesystem::create_symlink("loop", folder.beside("loop"));
  EXPECT_FALSE(read_if_there(folder.beside("loop")));
}

TEST(DataSetTest, OutputsDoNotTakeThePlaceOfWhatTheFolderConsistsOf) {
  const test::PlannedFolder folder;
  const DataSet data{folder.folder()};
  EXPECT_TRUE(data.may_write(folder.beside("page.html")));
  EXPECT_TRUE(data.may_write(data.derived("page.html")));
  EXPECT_TRUE(data.may_write("/dev/stdout"));
  EXPECT_TRUE(data.may_write("/proc/self/fd/none"));
  EXPECT_FALSE(data.may_write(data.folder + "/participants.tsv"));
  EXPECT_FALSE(data.may_write(data.derived("../../code/key.json")));
  std::filesystem::create_symlink(data.code("plan.json"), folder.beside("link"));
  EXPECT_FALSE(data.may_write(folder.beside("link")));
}

TEST(DataSetTest, NothingIsWrittenIntoAnyStudysFolder) {
  const test::PlannedFolder folder;
  const DataSet data{folder.folder()};
  EXPECT_TRUE(beside_studies(folder.beside("page.json")));
  EXPECT_TRUE(beside_studies(data.derived("page.json")));
  EXPECT_TRUE(beside_studies("/dev/stdout"));
  EXPECT_TRUE(beside_studies("page.json"));
  for (const std::string& path : {data.code("key.json"),
                                  data.folder + "/new.json",
                                  data.folder + "/sub-01/new/one.json",
                                  data.derived("../../code/plan.json")}) {
    EXPECT_FALSE(beside_studies(path)) << path;
  }
  std::filesystem::create_symlink(data.code("key.json"), folder.beside("key"));
  EXPECT_FALSE(beside_studies(folder.beside("key")));
}

TEST(DataSetTest, AFolderWithoutAStudyIsNone) {
  const auto planned = open_study("/nowhere");
  ASSERT_FALSE(planned);
  EXPECT_NE(planned.error().text.find("palp-study plan"), std::string::npos);
}

}  // namespace
}  // namespace palp::study
