#include "study/real_sites/site_session.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/io/realtime/steady_clock.h"
#include "tests/support/own_path.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using std::chrono_literals::operator""s;

/// Programs of shell in place of the sites'.
class StandIns {
 public:
  StandIns(const std::string& patient, const std::string& surgeon) {
    fs::create_directories(folder_);
    write("palp-patient", patient);
    write("palp-surgeon", surgeon);
  }
  ~StandIns() { fs::remove_all(folder_); }
  [[nodiscard]] SiteSetting setting() const {
    return {.programs = folder_, .work = folder_, .tissue = "x", .traces = folder_ / "run"};
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file{folder_ / name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }

 private:
  void write(const std::string& name, const std::string& script) const {
    std::ofstream{folder_ / name} << "#!/bin/sh\n" << script;
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }
  fs::path folder_{palp::test::own_path("sites")};
};

const std::string kListens = "echo 'listening on 127.0.0.1:7, as ever'; exec sleep 60\n";

TEST(SiteSessionTest, HearsThePageTheNewsAndTheAnswersOfASite) {
  const StandIns programs{kListens, R"(
printf '{"page":"http://here"}' >&3
printf '{"at_ns":1,"engaged":true,"force_n":0.5,"contact_n":0.6,"x_mm":3,"y_mm":-4}' >&3
printf '{"answer":2,"trial":9,"at_ns":77}' >&3
exec sleep 60
)"};
  auto session = SiteSession::start({.coupling = "mmt", .grip = "mid"}, programs.setting());
  ASSERT_TRUE(session) << session.error().text;
  EXPECT_EQ(session->page(), "http://here");
  std::optional<SiteAnswer> answer;
  for (int i = 0; i < 1000 && !answer; ++i) {
    session->listen();
    answer = session->take_answer();
  }
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->trial, 9U);
  EXPECT_EQ(answer->choice, 2U);
  EXPECT_EQ(answer->at, TimePoint{Duration{77}});
  EXPECT_FALSE(session->take_answer());
  EXPECT_TRUE(session->news().engaged);
  EXPECT_DOUBLE_EQ(session->news().contact_force, 0.6);
  EXPECT_NEAR(session->news().stands.y, -4e-3, 1e-12);
  EXPECT_FALSE(session->fault());
}

TEST(SiteSessionTest, AButtonAnswersWhicheverTrialAsks) {
  const StandIns programs{kListens, R"(
printf '{"page":"http://here"}' >&3
printf '{"answer":1,"at_ns":78}' >&3
exec sleep 60
)"};
  auto session = SiteSession::start({.coupling = "mmt", .grip = "mid"}, programs.setting());
  ASSERT_TRUE(session) << session.error().text;
  std::optional<SiteAnswer> answer;
  for (int i = 0; i < 1000 && !answer; ++i) {
    session->listen();
    answer = session->take_answer();
  }
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->trial, 0U);
  EXPECT_EQ(answer->choice, 1U);
}

TEST(SiteSessionTest, TheConditionIsInWhatTheSitesRead) {
  // Its inputs are gone once it runs, for nobody is to read them while trials are given.
  const StandIns programs{
      kListens,
      "cd \"$(dirname \"$0\")\"; for i in patient surgeon; do cp $i.textproto "
      "$i.kept; done; cp tray.csv tray.kept; printf '{\"page\":\"p\"}' >&3; exec "
      "sleep 60\n"};
  const Condition condition{.coupling = "wave",
                            .up = "delay_ms: 30",
                            .down = "delay_ms: 40",
                            .grip = "firm",
                            .feedback = Feedback::None};
  ASSERT_TRUE(SiteSession::start(condition, programs.setting()));
  EXPECT_EQ(programs.read("patient.kept"), "impairment {delay_ms: 30}\n");
  EXPECT_EQ(programs.read("surgeon.kept"),
            "impairment {delay_ms: 40}\nforce_gate { force_max_n: 0 }\n");
  EXPECT_EQ(programs.read("tray.kept"), "x");
  for (const char* const gone : {"tray.csv", "patient.textproto", "surgeon.textproto"}) {
    EXPECT_EQ(programs.read(gone), "") << gone;
  }
}

// Two answers one after the other, and one that is no whole number.
TEST(SiteSessionTest, TheFirstAnswerCounts) {
  const StandIns programs{kListens, R"(
printf '{"answer":1.7,"trial":9,"at_ns":76}' >&3
printf '{"answer":2,"trial":9,"at_ns":77}' >&3
printf '{"answer":1,"trial":9,"at_ns":78}' >&3
printf '{"page":"http://here"}' >&3
exec sleep 60
)"};
  auto session = SiteSession::start({.coupling = "mmt", .grip = "mid"}, programs.setting());
  ASSERT_TRUE(session) << session.error().text;
  const auto answer = session->take_answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->choice, 2U);
}

TEST(SiteSessionTest, ARelayThatDoesNotStartIsAReason) {
  const StandIns programs{kListens, "exec sleep 60\n"};
  SiteSetting setting = programs.setting();
  setting.changes_delay = true;
  const auto refused = SiteSession::start({}, setting);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("relay"), std::string::npos) << refused.error().text;
}

TEST(SiteSessionTest, ASiteThatEndsIsQuoted) {
  const StandIns none{"echo 'palp-patient: no such tissue'; exit 2\n", ""};
  const auto refused = SiteSession::start({}, none.setting());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text,
            "the patient's site does not start: palp-patient: no such tissue");
  const StandIns brief{kListens,
                       "printf '{\"page\":\"p\"}' >&3; echo 'palp-surgeon: had enough'\n"};
  auto session = SiteSession::start({}, brief.setting());
  ASSERT_TRUE(session) << session.error().text;
  // A pipe that is closed makes nobody wait.
  const TimePoint until = io::SteadyClock{}.now() + std::chrono::seconds{9};
  while (!session->fault() && io::SteadyClock{}.now() < until) {
    session->listen();
  }
  ASSERT_TRUE(session->fault());
  EXPECT_EQ(session->fault()->text, "the surgeon's site has ended: palp-surgeon: had enough");
}

// What a site says while it runs names forces, places and the link.
TEST(SiteSessionTest, NoLineButAReasonIsQuoted) {
  const StandIns brief{kListens, "printf '{\"page\":\"p\"}' >&3; echo 'ENGAGED rtt 20 ms'\n"};
  auto session = SiteSession::start({}, brief.setting());
  ASSERT_TRUE(session) << session.error().text;
  const TimePoint until = io::SteadyClock{}.now() + std::chrono::seconds{9};
  while (!session->fault() && io::SteadyClock{}.now() < until) session->listen();
  ASSERT_TRUE(session->fault());
  EXPECT_EQ(session->fault()->text, "the surgeon's site has ended");
}

}  // namespace
}  // namespace palp::study
