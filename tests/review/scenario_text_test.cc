#include "review/scenario_text.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/config.pb.h"
#include "tests/review/lab_files.h"
#include "tests/support/own_path.h"

namespace palp::review {
namespace {

using testing::HasSubstr;

/// Two taps over a path that is not the same both ways, recorded.
class ScenarioTextTest : public testing::Test {
 protected:
  ScenarioTextTest()
      : scenario_{test::lab_scenario(std::chrono::seconds{10},
                                     {"up.delay_ms=30", "down.delay_ms=50", "down.loss=0.05"},
                                     "standard")} {
    run_ = lab::simulate(scenario_, {.surgeon = &files_.surgeon, .patient = &files_.patient});
    std::ofstream out{path_, std::ios::binary};
    const auto bytes = files_.surgeon.bytes();
    for (const std::byte byte : bytes) out.put(static_cast<char>(byte));
  }
  ~ScenarioTextTest() override { std::filesystem::remove(path_); }
  ScenarioTextTest(const ScenarioTextTest&) = delete;
  ScenarioTextTest& operator=(const ScenarioTextTest&) = delete;

  [[nodiscard]] SessionPair pair() const {
    return pair_of(load_site(files_.surgeon.bytes(), "s", link::Role::Surgeon).value(),
                   load_site(files_.patient.bytes(), "p", link::Role::Patient).value())
        .value();
  }
  /// What the lab makes of the text, after one more setting.
  static lab::Scenario again(const std::string& text, const std::string& coupling) {
    auto document = config::scenario_document();
    EXPECT_TRUE(document.merge(text, "again"));
    for (const char* site : {"surgeon", "patient"}) {
      EXPECT_TRUE(document.set(std::string{site} + ".coupling.name=" + coupling));
    }
    EXPECT_TRUE(document.check());
    return lab::make_scenario("again", document).value();
  }

  const std::string path_{palp::test::own_path("scenario_text_test.mcap")};
  lab::Scenario scenario_;
  test::LabFiles files_;
  lab::RunResult run_;
};

TEST_F(ScenarioTextTest, ThePathIsTheOneThatTheSessionMeasured) {
  const auto text = scenario_text(pair(), path_);
  ASSERT_TRUE(text) << text.error().text;
  auto document = config::scenario_document();
  ASSERT_TRUE(document.merge(*text, "again"));
  const auto& read = document.as<proto::config::LabScenario>();
  EXPECT_NEAR(read.up().delay_ms() + read.down().delay_ms(), 80, 2);
  EXPECT_NEAR(read.up().delay_ms(), 30, 12) << "as well as the sites knew it";
  EXPECT_NEAR(read.down().loss(), 0.05, 0.015);
  EXPECT_EQ(read.up().loss(), 0);
}

TEST_F(ScenarioTextTest, UnderItsOwnCouplingTheRecordedHandFeelsTheSame) {
  const auto text = scenario_text(pair(), path_);
  ASSERT_TRUE(text) << text.error().text;
  lab::Scenario same = again(*text, "mmt");
  same.duration = scenario_.duration;
  const lab::RunResult once_more = lab::simulate(same, {});
  EXPECT_NEAR(once_more.metrics.force_peak, run_.metrics.force_peak, 0.1 * run_.metrics.force_peak);
}

TEST_F(ScenarioTextTest, UnderAnotherCouplingItFeelsAnother) {
  const auto text = scenario_text(pair(), path_);
  ASSERT_TRUE(text) << text.error().text;
  lab::Scenario other = again(*text, "wave");
  other.duration = scenario_.duration;
  const lab::RunResult made = lab::simulate(other, {});
  EXPECT_GT(made.metrics.force_rms, 2 * run_.metrics.force_rms) << "taps are off by more";
}

TEST_F(ScenarioTextTest, ARealTissueIsInNoFile) {
  SessionPair real = pair();
  real.patient.texts.tissue_csv.reset();
  real.patient.texts.tissue_words.reset();
  const auto refused = scenario_text(real, path_);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text, HasSubstr("tissue was real"));
}

TEST_F(ScenarioTextTest, WithoutSettingsThereIsNoScenario) {
  SessionPair bare = pair();
  bare.patient.texts.settings.reset();
  const auto refused = scenario_text(bare, path_);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text, HasSubstr("no settings"));
}

}  // namespace
}  // namespace palp::review
