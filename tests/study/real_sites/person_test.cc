#include "study/real_sites/person.h"

#include <gtest/gtest.h>

#include "tests/support/own_path.h"

namespace palp::study {
namespace {

const std::string kStudy = "name: \"s\" participants: 1 condition { name: \"one\" } ";

TEST(PersonTest, AComparisonWithTheOwnFingerIsRefused) {
  const Study study = *parse_study(kStudy + "task: \"bias\"", "s");
  const auto person = Person::make(study, {});
  ASSERT_FALSE(person);
  EXPECT_NE(person.error().text.find("task bias"), std::string::npos);
}

TEST(PersonTest, SitesThatDoNotStartAreAReason) {
  const std::string folder = palp::test::own_path("person");
  const Study study = *parse_study(kStudy, "s");
  const auto person = Person::make(
      study, {.programs = "/no/such/folder", .data = {folder}, .say = [](const std::string&) {}});
  ASSERT_TRUE(person);
  const auto outcome = (*person)->answer({0, 0}, {.level = study.levels[3]});
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().text.find("the patient's site does not start"), std::string::npos);
}

}  // namespace
}  // namespace palp::study
