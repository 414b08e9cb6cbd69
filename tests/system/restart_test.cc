#include <csignal>
#include <filesystem>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/io/realtime/steady_clock.h"
#include "tests/system/process.h"
#include "tests/system/session_files.h"

/// Goal: a site that dies in the tissue harms nobody, its file stays readable, and a new process
/// in its place is a new session.
/// Method: SIGKILL in a long press, a restart once the other site has parked; then the files. The
/// sites and the test read the same clock.
namespace palp::system_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kHoldAfter = milliseconds{100};
constexpr Duration kSurgeonRetractsAfter = seconds{2};
constexpr Duration kPatientRetractsAfter = milliseconds{500};
constexpr double kForceStepMax = 0.5;  // [N] in 10 ms: what a hand is not startled by

constexpr char kScript[] =
    "move -3 0.5\n"
    "press 7 0.8 7\n"
    "lift 0.6 0.5\n"
    "site B\n"
    "taps 1 4 1 0.5\n"
    "lift 0.5 0.2\n";

class RestartTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write_text(path("script.txt"), kScript);
    ASSERT_TRUE(make_certificates(path("keys")));
  }
  ~RestartTest() override {
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }

  /// `name` is that of the session file and of the log.
  [[nodiscard]] Process start_patient(const std::string& name, const std::string& address) const {
    return {"palp-patient",
            {"--listen",
             address,
             "--identity",
             path("keys/patient"),
             "--phantom",
             "closed-form",
             "--session-file",
             path(name + ".mcap")},
            path(name + ".log")};
  }
  [[nodiscard]] Process start_surgeon(const std::string& name, const std::string& peer) const {
    return {"palp-surgeon",
            {"--peer",
             peer,
             "--identity",
             path("keys/surgeon"),
             "--master",
             "script:" + path("script.txt"),
             "--session-file",
             path(name + ".mcap")},
            path(name + ".log")};
  }
  /// Waits until the patient's status line tells of a force that only the press makes.
  static bool wait_for_press(const Process& patient) {
    const std::regex pressed{"contact (0\\.[89]|1\\.)"};
    const TimePoint deadline = io::SteadyClock{}.now() + seconds{30};
    while (!std::regex_search(patient.output(), pressed)) {
      if (io::SteadyClock{}.now() > deadline) return false;
      ::usleep(5000);
    }
    return true;
  }
  /// @returns the instant.
  static TimePoint kill(Process& process) {
    const TimePoint killed_at = io::SteadyClock{}.now();
    process.signal(SIGKILL);
    EXPECT_EQ(process.wait(seconds{20}), 128 + SIGKILL);
    return killed_at;
  }
  /// The file of the dead has everything but, at most, its last second.
  void expect_readable_to_the_end(const std::string& name, TimePoint killed_at) const {
    const SessionFile file = read_session(path(name + ".mcap"));
    EXPECT_FALSE(file.closed);
    ASSERT_FALSE(file.ticks.empty());
    EXPECT_LT(killed_at - file.ticks.back().at, seconds{1});
    EXPECT_EQ(file.ticks.back().state, SiteState::Engaged);
  }
  /// Hold, then Retract, each after its gap, then Parked; then engaged again.
  static void expect_refuge(const SessionFile& file, TimePoint killed_at, Duration retracts_after) {
    const auto hold = change_to(file, SiteState::Hold, killed_at);
    ASSERT_TRUE(hold);
    EXPECT_GT(*hold - last_arrival_before(file, *hold), kHoldAfter);
    const auto retract = change_to(file, SiteState::Retract, *hold);
    ASSERT_TRUE(retract);
    EXPECT_GT(*retract - last_arrival_before(file, *retract), retracts_after);
    EXPECT_FALSE(change_to(file, SiteState::Engaged, *hold) < retract)
        << "engaged again without a peer";
    const auto parked = change_to(file, SiteState::Parked, *retract);
    ASSERT_TRUE(parked);
    EXPECT_TRUE(change_to(file, SiteState::Engaged, *parked));
  }
  static void expect_gentle(const SessionFile& file) {
    ASSERT_FALSE(file.ticks.empty());
    const ForceStep step = largest_force_step(file, milliseconds{10});
    EXPECT_LE(step.force, kForceStepMax)
        << "in " << to_string(step.state) << ", " << palp::seconds(step.at - file.ticks.front().at)
        << " s from the begin";
  }

  std::string folder_{make_folder("restart")};
};

TEST_F(RestartTest, SurgeonOutlivesItsPatientSite) {
  Process first = start_patient("first", "127.0.0.1:0");
  const std::string address = first.address();
  ASSERT_NE(address, "") << first.output();
  Process surgeon = start_surgeon("surgeon", address);
  ASSERT_TRUE(wait_for_press(first)) << first.output();
  const TimePoint killed_at = kill(first);
  ASSERT_TRUE(surgeon.wait_for("RETRACT -> PARKED", seconds{20})) << surgeon.output();
  Process second = start_patient("second", address);
  ASSERT_EQ(surgeon.wait(seconds{60}), 0) << surgeon.output();
  EXPECT_TRUE(second.wait_for("-> PARKED", seconds{20})) << second.output();
  second.signal(SIGINT);
  EXPECT_EQ(second.wait(seconds{20}), 0) << second.output();

  expect_readable_to_the_end("first", killed_at);
  const SessionFile file = read_session(path("surgeon.mcap"));
  EXPECT_TRUE(file.closed);
  expect_refuge(file, killed_at, kSurgeonRetractsAfter);
  expect_gentle(file);
  EXPECT_TRUE(change_to(read_session(path("second.mcap")), SiteState::Engaged));
}

TEST_F(RestartTest, PatientOutlivesItsSurgeonSite) {
  Process patient = start_patient("patient", "127.0.0.1:0");
  const std::string address = patient.address();
  ASSERT_NE(address, "") << patient.output();
  Process first = start_surgeon("first", address);
  ASSERT_TRUE(wait_for_press(patient)) << patient.output();
  const TimePoint killed_at = kill(first);
  ASSERT_TRUE(patient.wait_for("RETRACT -> PARKED", seconds{20})) << patient.output();
  Process second = start_surgeon("second", address);
  ASSERT_EQ(second.wait(seconds{60}), 0) << second.output();
  patient.signal(SIGINT);
  EXPECT_EQ(patient.wait(seconds{20}), 0) << patient.output();

  expect_readable_to_the_end("first", killed_at);
  const SessionFile file = read_session(path("patient.mcap"));
  EXPECT_TRUE(file.closed);
  expect_refuge(file, killed_at, kPatientRetractsAfter);
  expect_gentle(read_session(path("first.mcap")));
  expect_gentle(read_session(path("second.mcap")));
}

}  // namespace
}  // namespace palp::system_test
