#include "study/report_command.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(ReportCommandTest, IsBlindUntilUnblindedAndThatIsWrittenDown) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const std::string page = folder.folder() + "/derivatives/palp-study/report.html";
  const std::string log = folder.folder() + "/code/unblinded.txt";
  const auto end = run_report({.folder = folder.folder()});
  EXPECT_EQ(end.code, config::ExitCode::Done) << end.text;
  EXPECT_NE(test::content_of(page).find("condition A"), std::string::npos);
  EXPECT_EQ(test::content_of(page).find("condition wool"), std::string::npos);
  EXPECT_EQ(test::content_of(log), "");
  (void)run_report({.folder = folder.folder(), .unblind = true});
  EXPECT_NE(test::content_of(page).find("condition wool"), std::string::npos);
  EXPECT_NE(test::content_of(log).find("of 3 participants"), std::string::npos);
}

TEST(ReportCommandTest, DrawsTheFiguresBesideThePage) {
  const test::PlannedFolder folder;
  (void)folder.run();
  (void)run_report({.folder = folder.folder(), .out = folder.beside("page.html")});
  EXPECT_NE(test::content_of(folder.beside("page.html")).find("<svg"), std::string::npos);
  for (const char* name : {"jnd.svg", "answers.svg"}) {
    EXPECT_NE(test::content_of(folder.folder() + "/derivatives/palp-study/" + name).find("<svg"),
              std::string::npos);
  }
}

TEST(ReportCommandTest, NobodyAnsweredIsNoReport) {
  const test::PlannedFolder folder;
  EXPECT_EQ(run_report({.folder = folder.folder()}).code, config::ExitCode::BadInput);
}

}  // namespace
}  // namespace palp::study
