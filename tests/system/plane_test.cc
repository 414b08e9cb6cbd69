#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/surveyed_tissue.h"
#include "tests/system/process.h"
#include "tests/system/session_files.h"

/// Goal: a session in the plane ends in order, and its log says where.
/// Method: both programs over the loopback interface, a tissue known at several places by file, a
/// script by coordinates that taps and drags.
namespace palp::system_test {
namespace {

using std::chrono::seconds;

TEST(PlaneTest, TheLogOfADragShowsXAndY) {
  const std::string folder = make_folder("plane");
  const auto path = [&](const char* name) { return folder + "/" + name; };
  write_text(path("tissue.csv"), test::surveyed_tissue_csv());
  write_text(path("script.txt"), test::kPlaneScript);
  Process patient{"palp-patient",
                  {"--listen",
                   "127.0.0.1:0",
                   "--insecure",
                   "--phantom",
                   "file:" + path("tissue.csv"),
                   "--session-file",
                   path("patient.mcap")},
                  path("patient.log")};
  const std::string address = patient.address();
  ASSERT_NE(address, "") << patient.output();
  Process surgeon{"palp-surgeon",
                  {"--peer",
                   address,
                   "--insecure",
                   "--master",
                   "script:" + path("script.txt"),
                   "--session-file",
                   path("surgeon.mcap")},
                  path("surgeon.log")};
  EXPECT_EQ(surgeon.wait(seconds{120}), 0) << surgeon.output();
  patient.signal(SIGINT);
  EXPECT_EQ(patient.wait(seconds{30}), 0) << patient.output();

  const SessionFile file = read_session(path("patient.mcap"));
  double drag_begins = 1;  // [m]
  double drag_ends = -1;   // [m]
  double reached = -1;     // [m], of x at y = 0
  for (const SiteTick& tick : file.ticks) {
    const bool on_drag = std::abs(tick.place.y - 2e-3) < 1e-6;
    if (std::abs(tick.place.y) < 1e-6) reached = std::max(reached, tick.place.x);
    if (!on_drag || tick.force < 0.2) continue;
    drag_begins = std::min(drag_begins, tick.place.x);
    drag_ends = std::max(drag_ends, tick.place.x);
  }
  EXPECT_NEAR(reached, 10e-3, 1e-6);
  EXPECT_NEAR(drag_begins, -5e-3, 1e-4);
  EXPECT_NEAR(drag_ends, 25e-3, 1e-4);
  if (!testing::Test::HasFailure()) std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace palp::system_test
