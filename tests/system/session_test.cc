#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/record/mapped_file.h"
#include "common/record/session_reader.h"
#include "tests/system/process.h"
#include "tests/system/session_files.h"

/// Goal: a whole session through the emulated link ends in order and leaves sound files.
/// Method: the four programs, a script of one tap at either site.
namespace palp::system_test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

constexpr char kScript[] =
    "move -3 0.5\n"
    "taps 1 4 1 0.5\n"
    "lift 0.5 0.2\n"
    "site B\n"
    "move -3 0.5\n"
    "taps 1 4 1 0.5\n"
    "lift 0.5 0.2\n";

nlohmann::json report(const std::string& path) {
  std::ifstream file{path};
  return nlohmann::json::parse(file, nullptr, false);
}

class SessionTest : public ::testing::Test {
 protected:
  ~SessionTest() override {
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }

  /// The file of `site` is sound to palp-review and holds as many messages as the site counted.
  void expect_sound_file(const std::string& site) const {
    const nlohmann::json account = report(path(site + ".json"));
    ASSERT_TRUE(account.is_object()) << site;
    EXPECT_EQ(account["schema"], "palp.site/2");
    EXPECT_EQ(account["site"], site);
    EXPECT_EQ(account["exit_code"], 0);
    EXPECT_EQ(account["records_dropped"], 0);
    Process check{"palp-review", {"check", path(site + ".mcap")}, path(site + ".check")};
    EXPECT_EQ(check.wait(seconds{60}), 0) << check.output();
    const SessionFile file = read_session(path(site + ".mcap"));
    EXPECT_TRUE(file.closed);
    EXPECT_EQ(file.messages, account["messages"]);
    EXPECT_EQ(file.ticks.size(), account["records"]["tick"]);
    EXPECT_EQ(file.arrivals.size(), account["records"]["arrived"]);
  }

  /// What palp-review finds in the files alone equals the programs' reports to the last digit.
  void expect_what_the_programs_said() const {
    Process metrics{"palp-review",
                    {"metrics",
                     "--surgeon",
                     path("surgeon.mcap"),
                     "--patient",
                     path("patient.mcap"),
                     "--report",
                     path("review.json")},
                    path("review.log")};
    ASSERT_EQ(metrics.wait(seconds{60}), 0) << metrics.output();
    const nlohmann::json review = report(path("review.json"));
    for (const std::string site : {"surgeon", "patient"}) {
      const nlohmann::json program = report(path(site + ".json"));
      for (const char* key : {"ticks",
                              "missed_ticks",
                              "lateness_p999_us",
                              "messages",
                              "records_written",
                              "records_dropped",
                              "rejected",
                              "late",
                              "repaired"}) {
        EXPECT_EQ(review["sites"][site][key], program[key]) << site << ' ' << key;
      }
    }
    EXPECT_EQ(review["link"]["achieved"]["rtt_p50_ms"],
              report(path("surgeon.json"))["round_trip_p50_ms"]);
  }

  /// What the file says of the session's making is all there. @returns the fingerprints of the
  /// site's own certificate and of its peer's.
  [[nodiscard]] std::pair<std::string, std::string> expect_told_of(const std::string& site) const {
    const auto file = record::MappedFile::open(path(site + ".mcap"));
    if (!file) return {};
    record::SessionReader reader{file->bytes()};
    while (reader.next()) {
    }
    std::vector<std::string> keys{"program",
                                  "version",
                                  "git_commit",
                                  "protocol_version",
                                  "host_kernel",
                                  "seed",
                                  "coupling",
                                  "identity",
                                  "certificate_sha256",
                                  "began_utc",
                                  "time_zone",
                                  "clock_source",
                                  "clock_synchronised"};
    const std::vector<std::string> own =
        site == "surgeon"
            ? std::vector<std::string>{"master", "grip", "hand"}
            : std::vector<std::string>{"estimator", "stage", "force_sensor", "phantom_name"};
    keys.insert(keys.end(), own.begin(), own.end());
    for (const std::string& key : keys) {
      EXPECT_NE(reader.metadata("palp", key).value_or(""), "") << site << ": " << key;
    }
    EXPECT_NE(reader.metadata("palp.peer", "session_id").value_or(""), "") << site;
    EXPECT_THAT(std::string{reader.attachment("config.textproto").value_or("")},
                HasSubstr(site == "surgeon" ? "grip:" : "phantom:"))
        << site << ": what nobody set is in it as well";
    return {reader.metadata("palp", "certificate_sha256").value_or(""),
            reader.metadata("palp.peer", "certificate_sha256").value_or("")};
  }

  std::string folder_{make_folder("session")};
};

TEST_F(SessionTest, EndsInOrderAndLeavesSoundFiles) {
  write_text(path("script.txt"), kScript);
  ASSERT_TRUE(make_certificates(path("keys")));
  const auto with_files = [this](std::string site, std::vector<std::string> arguments) {
    const std::vector<std::string> more{"--identity",
                                        path("keys/" + site),
                                        "--session-file",
                                        path(site + ".mcap"),
                                        "--report",
                                        path(site + ".json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process{"palp-" + site, arguments, path(site + ".log")};
  };
  Process patient = with_files("patient", {"--listen", "127.0.0.1:0"});
  const std::string patient_address = patient.address();
  ASSERT_NE(patient_address, "") << patient.output();
  Process relay{"palp-netem",
                {"relay",
                 "--listen",
                 "127.0.0.1:0",
                 "--forward",
                 patient_address,
                 "--rtt-ms",
                 "5",
                 "--report",
                 path("relay.json")},
                path("relay.log")};
  const std::string relay_address = relay.address();
  ASSERT_NE(relay_address, "") << relay.output();
  Process surgeon =
      with_files("surgeon", {"--peer", relay_address, "--master", "script:" + path("script.txt")});

  ASSERT_EQ(surgeon.wait(seconds{60}), 0) << surgeon.output();
  EXPECT_TRUE(patient.wait_for("-> PARKED", seconds{20})) << patient.output();
  patient.signal(SIGINT);
  relay.signal(SIGINT);
  EXPECT_EQ(patient.wait(seconds{20}), 0) << patient.output();
  EXPECT_EQ(relay.wait(seconds{20}), 0) << relay.output();

  expect_sound_file("surgeon");
  expect_sound_file("patient");
  expect_what_the_programs_said();
  const auto [surgeons, of_patient] = expect_told_of("surgeon");
  const auto [patients, of_surgeon] = expect_told_of("patient");
  EXPECT_EQ(surgeons.size(), 64U);
  EXPECT_EQ(surgeons, of_surgeon) << "each knows the other by its certificate";
  EXPECT_EQ(patients, of_patient);
  const nlohmann::json link = report(path("relay.json"));
  ASSERT_TRUE(link.is_object());
  EXPECT_EQ(link["schema"], "palp.relay/1");
  EXPECT_GT(link["up"]["received"], 0);
  EXPECT_GT(link["down"]["received"], 0);
  EXPECT_EQ(report(path("patient.json"))["records"]["depth_estimate"], 2) << "one for each tap";
}

}  // namespace
}  // namespace palp::system_test
