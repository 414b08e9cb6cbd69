#include <algorithm>

#include <gtest/gtest.h>

#include "tests/house/arrows.h"
#include "tests/house/rules.h"
#include "tests/house/size_rules.h"
#include "tests/house/source.h"
#include "tests/house/tree_rules.h"

// Goal: what the reviewers of this project ask for everywhere is asked of every file, always.
// Method: the tree is read as text; each rule is a pure function whose own test (rules_test.cc)
// plants what it must find.
namespace palp::house {
namespace {

const Tree& tree() {
  static const Tree files = read_tree(PALP_TREE);
  return files;
}

class HouseTest : public testing::TestWithParam<Rule> {};

TEST_P(HouseTest, HoldsInEveryFile) {
  Violations found;
  for (const Source& source : tree()) {
    for (Violation& violation : GetParam().check(source)) found.push_back(std::move(violation));
  }
  EXPECT_TRUE(found.empty()) << listing(found);
}

INSTANTIATE_TEST_SUITE_P(Rules,
                         HouseTest,
                         testing::Values(Rule{"ForbiddenArrows", forbidden_arrows},
                                         Rule{"BrokenFences", broken_fences},
                                         Rule{"ClocksAndSleeps", clocks_and_sleeps},
                                         Rule{"Randomness", randomness},
                                         Rule{"Threads", threads},
                                         Rule{"SharedOwnership", shared_ownership},
                                         Rule{"TemporaryFiles", temporary_files},
                                         Rule{"UsingNamespace", using_namespace},
                                         Rule{"ConditionalCode", conditional_code},
                                         Rule{"ThrowOnRt", throw_on_rt},
                                         Rule{"MembersWithoutUnit", members_without_unit},
                                         Rule{"MissingPragmaOnce", missing_pragma_once},
                                         Rule{"LongFiles", long_files},
                                         Rule{"LongFunctions", long_functions},
                                         Rule{"CrowdedClasses", crowded_classes},
                                         Rule{"LongLines", long_lines},
                                         Rule{"HeavyFiles", heavy_files},
                                         Rule{"UnwantedWords", unwanted_words}),
                         [](const auto& rule) { return std::string{rule.param.name}; });

TEST(TreeTest, EveryHeaderIsReadByATest) {
  const Violations found = untested_headers(tree());
  EXPECT_TRUE(found.empty()) << listing(found);
}

TEST(TreeTest, EverySourceIsBuilt) {
  const Violations found = unlisted_sources(tree());
  EXPECT_TRUE(found.empty()) << listing(found);
}

TEST(TreeTest, SourcesThatMayBeJoinedShareNoNames) {
  const Violations found = repeated_names(tree());
  EXPECT_TRUE(found.empty()) << listing(found);
}

TEST(TreeTest, EveryPageCitedIsHere) {
  const Violations found = missing_pages(tree());
  EXPECT_TRUE(found.empty()) << listing(found);
}

TEST(TreeTest, TheTreeWasRead) {
  EXPECT_GT(tree().size(), 50U);
  EXPECT_TRUE(std::ranges::any_of(
      tree(), [](const Source& source) { return source.path == "common/core/time.h"; }));
}

}  // namespace
}  // namespace palp::house
