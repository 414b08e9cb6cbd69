// Goal: the program's verbs, exit codes and report as scripts rely on them.
// Method: write session files to a temporary folder, run palp-review on them.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "tests/review/session_samples.h"
#include "tests/support/own_path.h"

namespace palp::review {
namespace {

namespace fs = std::filesystem;

class PalpReviewTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = palp::test::own_path("review");
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const auto files = test::sample_session();
    save("s.mcap", files.surgeon);
    save("p.mcap", files.patient);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void save(const std::string& name, std::span<const std::byte> bytes) const {
    std::ofstream file{folder_ + '/' + name, std::ios::binary};
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream file{folder_ + '/' + name, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
  }
  /// @returns the exit code; what was printed stands in `output`.
  [[nodiscard]] int run(const std::string& arguments) const {
    const int status = std::system(
        ("cd '" + folder_ + "' && '" PALP_REVIEW_PROGRAM "' " + arguments + " > output 2>&1")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void cut_off(const std::string& name) const {
    fs::resize_file(folder_ + '/' + name, fs::file_size(folder_ + '/' + name) / 2);
  }

  std::string folder_;
};

TEST_F(PalpReviewTest, InfoAndCheckAcceptASoundFile) {
  EXPECT_EQ(run("info s.mcap"), 0);
  EXPECT_NE(text("output").find("surgeon/tick"), std::string::npos);
  EXPECT_EQ(run("check s.mcap"), 0);
}

TEST_F(PalpReviewTest, CheckFailsOnACutOffFileAndRecoverMendsIt) {
  cut_off("s.mcap");
  EXPECT_EQ(run("check s.mcap"), 1);
  EXPECT_EQ(run("recover s.mcap mended.mcap"), 0);
  EXPECT_EQ(run("check mended.mcap"), 0);
  EXPECT_EQ(run("recover s.mcap mended.mcap"), 3) << "never over an existing file";
  EXPECT_EQ(run("recover s.mcap s.mcap"), 3);
}

TEST_F(PalpReviewTest, WhereNothingIsNothingIsRecovered) {
  save("empty.mcap", {});
  EXPECT_EQ(run("info empty.mcap"), 2);
  fs::resize_file(folder_ + "/s.mcap", 100);
  for (const char* const file : {"empty.mcap", "s.mcap"}) {
    EXPECT_EQ(run(std::string{"recover "} + file + " out.mcap"), 2) << file;
    EXPECT_FALSE(fs::exists(folder_ + "/out.mcap"));
  }
}

TEST_F(PalpReviewTest, EveryVerbSaysWhatAFileLacks) {
  cut_off("s.mcap");
  const std::string pair = " --surgeon s.mcap --patient p.mcap ";
  for (const std::string& line : {std::string{"info s.mcap"},
                                  "metrics" + pair,
                                  "report" + pair + "--out r.html",
                                  "plot" + pair + "--svg p.svg",
                                  std::string{"compare s.mcap p.mcap"},
                                  std::string{"merge s.mcap p.mcap both.mcap"},
                                  std::string{"export s.mcap --topics surgeon/tick --out t.csv"}}) {
    EXPECT_EQ(run(line), 0) << line;
    EXPECT_NE(text("output").find("not closed"), std::string::npos) << line << text("output");
  }
}

TEST_F(PalpReviewTest, MetricsPrintsTheTapsAndWritesTheReport) {
  EXPECT_EQ(run("metrics --surgeon s.mcap --patient p.mcap --rtt-ms 20 --report r.json"), 0);
  EXPECT_NE(text("output").find("tap 3"), std::string::npos);
  const auto json = nlohmann::json::parse(text("r.json"));
  EXPECT_EQ(json["schema"], "palp.demo/1");
  EXPECT_EQ(json["taps"].size(), 6u);
  EXPECT_EQ(json["link"]["asked"]["rtt_ms"], 20);
}

TEST_F(PalpReviewTest, PlotDrawsForAPaperAndRefusesWhatItDoesNotKnow) {
  const std::string files = "plot --surgeon s.mcap --patient p.mcap ";
  EXPECT_EQ(run(files + "--svg s.svg --pdf s.pdf --style double --to 5"), 0) << text("output");
  EXPECT_NE(text("s.svg").find(">felt by the hand<"), std::string::npos);
  EXPECT_EQ(text("s.pdf").substr(0, 5), "%PDF-");
  EXPECT_EQ(run(files), 2) << "no picture is asked for";
  EXPECT_EQ(run(files + "--svg s.svg --style triple"), 2);
  EXPECT_EQ(run(files + "--svg no/such/folder/s.svg"), 3);
  EXPECT_EQ(run("plot --surgeon none.mcap --patient p.mcap --svg s.svg"), 3);
}

TEST_F(PalpReviewTest, MetricsWorksOnCutOffFilesAndWithoutOptionalReports) {
  cut_off("p.mcap");
  EXPECT_EQ(run("metrics --surgeon s.mcap --patient p.mcap --relay none.json --report r.json"), 0);
  EXPECT_EQ(nlohmann::json::parse(text("r.json"))["sites"]["patient"]["closed"], false);
}

TEST_F(PalpReviewTest, AFileThatIsNoSessionFileIsBadInputAndNothingIsMadeOfIt) {
  save("text.mcap", std::as_bytes(std::span{"d_mm,F_N"}));
  EXPECT_EQ(run("info text.mcap"), 2);
  EXPECT_EQ(run("recover text.mcap mended.mcap"), 2);
  EXPECT_FALSE(fs::exists(folder_ + "/mended.mcap"));
  EXPECT_EQ(run("metrics --surgeon text.mcap --patient p.mcap"), 2);
  EXPECT_EQ(run("check text.mcap"), 1);
}

TEST_F(PalpReviewTest, MergeAndExportWriteNewFilesAlone) {
  EXPECT_EQ(run("merge s.mcap p.mcap both.mcap"), 0);
  EXPECT_EQ(run("check both.mcap"), 0);
  EXPECT_EQ(run("merge s.mcap p.mcap both.mcap"), 3) << "never over an existing file";
  EXPECT_EQ(run("export s.mcap --topics surgeon/tick --from 1 --to 2 --out t.csv"), 0);
  EXPECT_EQ(text("t.csv").find("t_s,stamp_ns,state"), 0U);
  EXPECT_EQ(run("export s.mcap --topics surgeon/tick --out t.csv"), 3);
  EXPECT_EQ(run("export s.mcap --topics surgeon/nothing --out n.csv"), 2);
  EXPECT_FALSE(fs::exists(folder_ + "/n.csv"));
}

TEST_F(PalpReviewTest, ReportWritesAPageThatHoldsTheNumbers) {
  EXPECT_EQ(run("report --surgeon s.mcap --patient p.mcap --out r.html"), 0);
  EXPECT_EQ(text("output"), "report: r.html\n");
  EXPECT_NE(text("r.html").find("\"schema\":\"palp.demo/1\""), std::string::npos);
  save("empty.mcap", {});
  EXPECT_EQ(run("report --surgeon empty.mcap --patient p.mcap --out e.html"), 2);
  EXPECT_FALSE(fs::exists(folder_ + "/e.html"));
}

TEST_F(PalpReviewTest, MetricsPrintsTheReportWhereAsked) {
  EXPECT_EQ(run("metrics --json --surgeon s.mcap --patient p.mcap"), 0);
  EXPECT_EQ(nlohmann::json::parse(text("output"))["metrics"]["phases_known"], false);
}

TEST_F(PalpReviewTest, CompareTakesSessionsInPairs) {
  EXPECT_EQ(run("compare s.mcap p.mcap s.mcap p.mcap"), 0);
  EXPECT_NE(text("output").find("force_peak_n"), std::string::npos);
  EXPECT_EQ(run("compare s.mcap p.mcap s.mcap"), 2);
}

TEST_F(PalpReviewTest, ReplaySaysInASentenceWhatAFileLacks) {
  EXPECT_EQ(run("replay s.mcap"), 2);
  EXPECT_NE(text("output").find("config.textproto"), std::string::npos);
}

TEST_F(PalpReviewTest, WrongFilesAndFlagsHaveTheirExitCodes) {
  EXPECT_EQ(run("info nothing.mcap"), 3);
  EXPECT_EQ(run("metrics --surgeon nothing.mcap --patient p.mcap"), 3);
  EXPECT_EQ(run("metrics --surgeon s.mcap --patient nothing.mcap"), 3);
  EXPECT_EQ(run("metrics --surgeon s.mcap --patient p.mcap --report none/r.json"), 3);
  EXPECT_EQ(run("metrics --surgeon p.mcap --patient s.mcap"), 2);
  EXPECT_EQ(run("metrics --surgeon s.mcap"), 2);
  EXPECT_EQ(run("polish s.mcap"), 2);
  EXPECT_EQ(run("--help"), 0);
}

}  // namespace
}  // namespace palp::review
