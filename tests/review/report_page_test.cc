#include "review/report_page.h"

#include <string_view>

#include <gtest/gtest.h>

#include "review/demo_report.h"
#include "tests/review/lab_files.h"

namespace palp::review {
namespace {

/// The page of a session in virtual time; `outcome` as the caller told it.
std::string page_of(const std::string& outcome) {
  const test::LabFiles files = test::lab_files(test::lab_scenario(std::chrono::seconds{12}));
  auto surgeon = load_site(files.surgeon.bytes(), "s", link::Role::Surgeon).value();
  auto patient = load_site(files.patient.bytes(), "p", link::Role::Patient).value();
  const SessionPair pair = pair_of(std::move(surgeon), std::move(patient)).value();
  ReportCurves curves;
  const JudgedSession judged = judge_session(pair, nullptr, &curves);
  const Touches taps = match_taps(pair.surgeon, pair.patient, pair.time_line, judged.excursions);
  Asked asked;
  asked.outcome = outcome;
  return report_page(pair, curves, demo_report(pair, taps, asked, {}, {}, metrics_json(judged)));
}

TEST(ReportPageTest, NeedsNothingFromOutside) {
  const std::string page = page_of("completed");
  for (const char* place : {"/*DATA*/", "/*UPLOT-CODE*/", "/*UPLOT-STYLE*/", "/*PLANE-CODE*/"}) {
    EXPECT_EQ(page.find(place), std::string::npos) << place << " was filled in";
  }
  for (const char* outside : {"src=", "<link", "@import"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  constexpr std::string_view kAddress = "url(";
  for (auto at = page.find(kAddress); at != std::string::npos; at = page.find(kAddress, at + 1)) {
    EXPECT_EQ(page[at + kAddress.size()], '#') << "a pattern of the page itself";
  }
  EXPECT_NE(page.find("Copyright"), std::string::npos) << "of the library";
  EXPECT_LT(page.size(), 3'000'000U);
}

TEST(ReportPageTest, NoTextOfAFileEndsTheScript) {
  const std::string page = page_of("</script><script>alert(1)</script>");
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
}

}  // namespace
}  // namespace palp::review
