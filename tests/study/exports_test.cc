#include "study/exports.h"

#include <gtest/gtest.h>

namespace palp::study {
namespace {

TrialRow a_row(TrialKind kind, const std::string& condition, double level, bool right) {
  TrialRow row{.ask = {.kind = kind, .level = level, .stronger = 1}, .condition = condition};
  row.outcome = {.chosen = right ? 1U : 0U, .response_time = 0.5};
  return row;
}

std::vector<ParticipantRows> some_rows() {
  return {{"sub-01",
           {a_row(TrialKind::Practice, "B", 1, true),
            a_row(TrialKind::Trial, "B", 0.2, true),
            a_row(TrialKind::Trial, "B", 0.2, false),
            a_row(TrialKind::Catch, "A", 1.2, true)}}};
}

TEST(ExportsTest, HaveTheColumnsThatTheirToolsDocument) {
  EXPECT_EQ(*export_text("psignifit", some_rows(), {}),
            "# sub-01 A: level_ln, right, all\n1.2 1 1\n"
            "# sub-01 B: level_ln, right, all\n0.2 1 2\n");
  EXPECT_EQ(*export_text("quickpsy", some_rows(), {}),
            "participant,condition,level,response,excluded\nsub-01,B,0.2,1,0\n"
            "sub-01,B,0.2,0,0\nsub-01,A,1.2,1,0\n");
  EXPECT_EQ(*export_text("psychopy", some_rows(), {}),
            "participant,session,trials.thisN,trials.intensity,trials.response,trials.rt,condition,"
            "excluded\n"
            "sub-01,01,0,0.2,1,0.5,B,0\nsub-01,01,1,0.2,0,0.5,B,0\nsub-01,01,2,1.2,1,0.5,A,0\n");
  EXPECT_EQ(*export_text("lme4", some_rows(), {}),
            "participant,condition,level,correct,trial,excluded\nsub-01,B,0.2,1,1,0\n"
            "sub-01,B,0.2,0,2,0\nsub-01,A,1.2,1,3,0\n");
  EXPECT_NE(export_text("palamedes", some_rows(), {})
                ->find("who{2} = 'sub-01 B';\nStimLevels{2} = [ 0.2 ];\nNumPos{2} = [ 1 ];\n"
                       "OutOfNum{2} = [ 2 ];\n"),
            std::string::npos);
}

TEST(ExportsTest, WhoIsExcludedIsMarked) {
  const std::string text = *export_text("lme4", some_rows(), {{"sub-01", "practice"}});
  EXPECT_NE(text.find("sub-01,A,1.2,1,3,1\n"), std::string::npos) << text;
}

TEST(ExportsTest, EveryFormatOfTheListIsThereAndNoOther) {
  for (const std::string_view format : kExportFormats)
    EXPECT_TRUE(export_text(format, some_rows(), {}));
  EXPECT_FALSE(export_text("spss", some_rows(), {}));
}

}  // namespace
}  // namespace palp::study
