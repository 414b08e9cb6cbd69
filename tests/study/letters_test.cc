#include "study/letters.h"

#include <set>

#include <gtest/gtest.h>

#include "study/compare_command.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(LettersTest, EveryOrderIsDrawn) {
  std::set<Letters> orders;
  for (std::uint64_t number = 0; number < 200; ++number) orders.insert(drawn_letters(3, number));
  EXPECT_EQ(orders.size(), 6U);
}

TEST(LettersTest, TheKeyComesBackAndPutsTheConditionsInTheOrderOfTheirLetters) {
  const Study study = test::small_study();
  const Letters letters{2, 0, 1};
  const auto read = parse_key(key_text(study, letters, "salt"), "key", study);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(*read, letters);
  const Study by_letters = lettered(study, *read);
  EXPECT_EQ(by_letters.conditions[0].name, "felt");
  EXPECT_EQ(by_letters.conditions[2].name, "wool");
}

TEST(LettersTest, AKeyThatDoesNotFitIsRefused) {
  const Study study = test::small_study();
  const std::string key = key_text(study, {2, 0, 1}, "salt");
  for (const auto& [from, to] : {std::pair{"wool", "silk"}, {"\"A\"", "\"D\""}, {"felt", "fel"}}) {
    std::string changed = key;
    changed.replace(changed.find(from), std::string{from}.size(), to);
    EXPECT_FALSE(parse_key(changed, "key", study)) << to;
  }
  EXPECT_FALSE(parse_key("", "key", study));
  EXPECT_FALSE(parse_key("[1, 2]", "key", study));
}

// The schedule says who begins with which letter; the study file's order must not say its name.
TEST(LettersTest, TheFirstConditionOfTheScheduleMayBeAny) {
  std::set<std::string> first;
  const Study study = test::small_study();
  for (std::uint64_t number = 0; number < 40; ++number) {
    const Study by_letters = lettered(study, drawn_letters(3, number));
    first.insert(by_letters.conditions[participant_plan(by_letters, 0)[0].condition].name);
  }
  EXPECT_EQ(first.size(), 3U);
}

TEST(LettersTest, WhatIsBlindGoesByLetters) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const std::string fit = run_fit_study(folder.folder(), "").text;
  EXPECT_LT(fit.find("condition A"), fit.find("condition B"));
  EXPECT_LT(fit.find("condition B"), fit.find("condition C"));
  const std::string table = test::content_of(folder.folder() + "/derivatives/palp-study/fit.tsv");
  EXPECT_LT(table.find("sub-01\tA"), table.find("sub-01\tB"));
  EXPECT_LT(table.find("sub-01\tB"), table.find("sub-01\tC"));
  const std::string pairs = run_compare(folder.folder()).text;
  EXPECT_NE(pairs.find("B : A"), std::string::npos);
  EXPECT_LT(pairs.find("B : A"), pairs.find("C : B"));
}

}  // namespace
}  // namespace palp::study
