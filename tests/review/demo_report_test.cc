#include "review/demo_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/record/notes.h"
#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

SessionPair sample_pair() {
  auto [surgeon, patient] = test::load(test::sample_session());
  return pair_of(std::move(surgeon), std::move(patient)).value();
}

nlohmann::json report(const ProgramReports& reports = {}, const Asked& asked = {}) {
  const SessionPair session = sample_pair();
  const auto tissue = judge::TissueTable::parse(*session.patient.texts.tissue_csv);
  const auto taps =
      match_taps(session.surgeon,
                 session.patient,
                 {},
                 test::find_excursions(test::hand_motion(3), test::kSurface, &*tissue));
  return nlohmann::json::parse(
      demo_report(session, taps, asked, reports, {"out/s.mcap", "out/p.mcap"}));
}

TEST(DemoReportTest, FirstKeyIsTheSchema) {
  const SessionPair session = sample_pair();
  const std::string text = demo_report(session, {}, {}, {}, {});
  EXPECT_EQ(text.substr(0, 29), "{\n  \"schema\": \"palp.demo/1\",\n");
}

TEST(DemoReportTest, HasEveryKeyAScriptMayRelyOn) {
  const auto json = report();
  for (const char* pointer : {"/outcome",
                              "/seed",
                              "/coupling",
                              "/preset",
                              "/grip",
                              "/phantom/name",
                              "/phantom/depth_mm",
                              "/phantom/radius_mm",
                              "/phantom/ratio",
                              "/phantom/shape",
                              "/link/asked/rtt_ms",
                              "/link/asked/jitter_ms",
                              "/link/asked/loss",
                              "/link/achieved/rtt_p50_ms",
                              "/link/achieved/up",
                              "/link/achieved/down",
                              "/taps/0/site",
                              "/taps/0/index",
                              "/taps/0/indentation_max_mm",
                              "/taps/0/force_max_n",
                              "/taps/0/stiffness_felt_n_per_m",
                              "/taps/0/stiffness_true_n_per_m",
                              "/taps/0/depth/verdict",
                              "/taps/0/depth/depth_mm",
                              "/taps/0/depth/low_mm",
                              "/taps/0/depth/high_mm",
                              "/taps/0/depth/stddev_mm",
                              "/taps/0/depth/h_n",
                              "/taps/0/depth/reason",
                              "/taps/0/depth/estimator",
                              "/depth/verdict",
                              "/depth/depth_mm",
                              "/depth/low_mm",
                              "/depth/high_mm",
                              "/sites/surgeon/session_file",
                              "/sites/surgeon/ticks",
                              "/sites/surgeon/missed_ticks",
                              "/sites/surgeon/lateness_p999_us",
                              "/sites/surgeon/records_written",
                              "/sites/surgeon/records_dropped",
                              "/sites/surgeon/rejected/malformed",
                              "/sites/surgeon/rejected/foreign",
                              "/sites/surgeon/rejected/replayed",
                              "/sites/surgeon/rejected/too_old",
                              "/sites/surgeon/rejected/forged",
                              "/sites/surgeon/late",
                              "/sites/surgeon/repaired",
                              "/sites/patient/session_file",
                              "/sites/patient/rejected",
                              "/transitions/0/site",
                              "/transitions/0/t_s",
                              "/transitions/0/from",
                              "/transitions/0/to",
                              "/transitions/0/reason"}) {
    EXPECT_TRUE(json.contains(nlohmann::json::json_pointer{pointer})) << pointer;
  }
}

TEST(DemoReportTest, TakesWhatTheProgramsDidNotSayFromTheSessionFiles) {
  const auto json = report();
  EXPECT_EQ(json["outcome"], nullptr);
  EXPECT_EQ(json["seed"], 42);
  EXPECT_EQ(json["coupling"], "direct");
  EXPECT_EQ(json["phantom"]["depth_mm"], 10);
  EXPECT_EQ(json["link"]["achieved"]["rtt_p50_ms"], 20);
  EXPECT_EQ(json["link"]["achieved"]["up"], nullptr);
  EXPECT_EQ(json["sites"]["surgeon"]["ticks"], 6000);
  EXPECT_EQ(json["sites"]["surgeon"]["rejected"]["forged"], 2);
  EXPECT_EQ(json["sites"]["surgeon"]["late"], 5);
  EXPECT_EQ(json["sites"]["surgeon"]["missed_ticks"], nullptr);
  EXPECT_EQ(json["sites"]["surgeon"]["records_dropped"], 0);
  EXPECT_EQ(json["sites"]["patient"]["rejected"], nullptr) << "its link never reported";
  EXPECT_EQ(json["transitions"][0]["reason"], "pedal pressed");
  EXPECT_EQ(json["transitions"][0]["t_s"], 0.5);
}

TEST(DemoReportTest, AReportOfAnotherSessionIsRefused) {
  SessionPair session = sample_pair();
  session.surgeon.texts.program_report =
      R"({"site":"surgeon","ticks":6000,"lateness_max_us":8477.513})";
  const auto refused = [&](const ProgramReports& reports) {
    const auto checked = check_reports(session, reports);
    return checked ? std::string{} : checked.error().text;
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.surgeon = "no JSON"}), "") << "told elsewhere";
  EXPECT_EQ(refused({.surgeon = R"({"site":"surgeon","ticks":6000,"lateness_max_us":8477.513})"}),
            "");
  EXPECT_NE(refused({.surgeon = R"({"ticks":5186})"}).find("ticks is 5186"), std::string::npos);
  EXPECT_NE(refused({.surgeon = R"({"lateness_max_us":1.5})"}), "");
  EXPECT_NE(refused({.surgeon = R"({"site":"patient"})"}).find("of another"), std::string::npos);
  EXPECT_EQ(refused({.patient = R"({"site":"patient","ticks":1})"}), "") << "its file is silent";
  session.patient.metadata.emplace_back("time", "virtual");
  EXPECT_NE(refused({.patient = R"({"ticks":1})"}).find("simulation"), std::string::npos);
}

TEST(DemoReportTest, ReportsOfTheProgramsOutrankTheFiles) {
  const auto json =
      report({.surgeon = R"({"schema":"palp.site/2","ticks":7,"outcome":"done","missed_ticks":3,
                     "round_trip_p50_ms":19.5})",
              .patient = R"({"records_dropped":9})",
              .relay = R"({"up":{"jitter_ms":0.5,"sent":100,"lost":1},"down":{"received":99}})"},
             {.preset = "metro-fibre", .rtt_ms = 20});
  EXPECT_EQ(json["outcome"], "done");
  EXPECT_EQ(json["sites"]["surgeon"]["ticks"], 7);
  EXPECT_EQ(json["sites"]["surgeon"]["missed_ticks"], 3);
  EXPECT_EQ(json["sites"]["patient"]["records_dropped"], 9);
  EXPECT_EQ(json["link"]["achieved"]["rtt_p50_ms"], 19.5);
  EXPECT_EQ(json["link"]["achieved"]["up"]["lost"], 1);
  EXPECT_EQ(json["link"]["achieved"]["up"]["jitter_ms"], 0.5);
  EXPECT_EQ(json["link"]["achieved"]["up"]["delay_p99_ms"], nullptr);
  EXPECT_EQ(json["link"]["achieved"]["down"]["received"], 99);
  EXPECT_EQ(json["preset"], "metro-fibre");
  EXPECT_EQ(json["link"]["asked"]["rtt_ms"], 20);
}

TEST(DemoReportTest, BrokenReportsCountAsAbsent) {
  const auto json = report({.surgeon = "{not json", .patient = "[1]", .relay = "7"});
  EXPECT_EQ(json["outcome"], nullptr);
  EXPECT_EQ(json["link"]["achieved"]["up"], nullptr);
}

TEST(DemoReportTest, DepthIsNullUnlessFoundAndIntervalUnlessGiven) {
  const auto json = report();
  EXPECT_EQ(json["taps"][0]["depth"]["verdict"], "none");
  EXPECT_EQ(json["taps"][0]["depth"]["depth_mm"], nullptr);
  EXPECT_EQ(json["taps"][0]["depth"]["h_n"], 0.059);
  EXPECT_EQ(json["taps"][3]["depth"]["verdict"], "found");
  EXPECT_NEAR(json["taps"][3]["depth"]["depth_mm"], 10.1, 1e-9);
  EXPECT_EQ(json["taps"][3]["depth"]["low_mm"], nullptr);
  EXPECT_EQ(json["taps"][3]["depth"]["stddev_mm"], nullptr);
  EXPECT_EQ(json["depth"]["verdict"], "found");
  EXPECT_NEAR(json["depth"]["depth_mm"], 10.2, 1e-9);
}

TEST(DemoReportTest, BothSitesMomentsStandOnTheSurgeonsLine) {
  SessionPair session = sample_pair();
  session.time_line.offset = std::chrono::seconds{5};
  Note mark;
  mark.at = session.surgeon.began_at + std::chrono::milliseconds{5750};
  mark.code = static_cast<std::uint16_t>(record::NoteCode::Marked);
  session.patient.notes = {mark};
  session.patient.transitions = {{.at = mark.at}};
  const auto json = nlohmann::json::parse(demo_report(session, {}, {}, {}, {}));
  EXPECT_NEAR(json["marks"].back()["t_s"], 0.75, 1e-9);
  EXPECT_EQ(json["transitions"].back()["site"], "patient");
  EXPECT_NEAR(json["transitions"].back()["t_s"], 0.75, 1e-9);
}

TEST(DemoReportTest, NumbersThatAreNoneAreNull) {
  SessionPair session = sample_pair();
  session.patient.estimates[0].hash = std::numeric_limits<double>::quiet_NaN();
  session.patient.estimates[0].force_max = std::numeric_limits<double>::infinity();
  const Touches taps = match_taps(session.surgeon, session.patient, {}, {});
  const auto json = nlohmann::json::parse(demo_report(session, taps, {}, {}, {}));
  EXPECT_EQ(json["taps"][0]["depth"]["h_n"], nullptr);
  EXPECT_EQ(json["taps"][0]["force_max_n"], nullptr);
  EXPECT_EQ(json["taps"][0]["stiffness_true_n_per_m"], nullptr);
}

}  // namespace
}  // namespace palp::review
