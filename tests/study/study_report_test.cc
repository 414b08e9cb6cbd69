#include "study/study_report.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

StudyFit fit_of(const test::PlannedFolder& folder) {
  (void)folder.run();
  const auto planned = *open_study(folder.folder());
  return fit_study(planned.study, *read_rows(planned));
}

TEST(StudyReportTest, NeedsNothingBesidesAndSaysWhatIsMissing) {
  const test::PlannedFolder folder;
  const Study study = test::small_study();
  const StudyFit fit = fit_of(folder);
  ReportParts parts{.standing = "exploratory: <b>",
                    .preregistration = "as & was",
                    .names = condition_codes(study),
                    .kind = "person"};
  const std::string page = report_html(study, fit, parts);
  for (const char* other : {"http:", "https:", "src=", "<script", "<b>"}) {
    std::string text = page;
    // Names of SVG's own are no addresses.
    for (std::size_t at; (at = text.find("http://www.w3.org")) != std::string::npos;) {
      text.erase(at, 17);
    }
    EXPECT_EQ(text.find(other), std::string::npos) << other;
  }
  EXPECT_NE(page.find("<td>Ethics</td><td>missing"), std::string::npos);
  EXPECT_NE(page.find("as &amp; was"), std::string::npos);
  parts.kind = "simulated";
  EXPECT_NE(report_html(study, fit, parts).find("nobody but programs"), std::string::npos);
}

TEST(StudyReportTest, EveryIntervalHoldsItsPoint) {
  const test::PlannedFolder folder;
  const Study study = test::small_study();
  const StudyFit fit = fit_of(folder);
  const auto names = condition_codes(study);
  for (const plot::Figure& figure :
       {jnd_figure(study, fit, names), answers_figure(study, fit, names)}) {
    for (const plot::Panel& panel : figure.panels) {
      for (const plot::Curve& curve : panel.curves) {
        EXPECT_FALSE(curve.x.empty());
        for (std::size_t i = 0; i < curve.low.size(); ++i) {
          EXPECT_LE(curve.low[i], curve.y[i]);
          EXPECT_GE(curve.high[i], curve.y[i]);
        }
      }
    }
  }
  EXPECT_EQ(answers_figure(study, fit, names).panels.size(), 3U);
  EXPECT_EQ(jnd_figure(study, fit, names).panels[0].curves[0].x.size(), 9U);
}

}  // namespace
}  // namespace palp::study
