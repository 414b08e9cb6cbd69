#include "surgeon_site/surgeon_control.h"

#include <gtest/gtest.h>

#include "tests/support/fake_recorder.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;

/// A site whose inputs a test makes up.
struct Bench {
  void hear(std::uint64_t session, const MapReport& map, const MapCell& cell = {}) {
    in.now += 1ms;
    in.hand.sampled_at = in.now;
    in.link.state = LinkState::Live;
    in.link.session_id = session;
    in.arrived.peer_heard = true;
    in.arrived.peer.map = map;
    in.arrived.peer.map_cell = cell;
    (void)control.step(in);
  }
  [[nodiscard]] std::vector<MapCell> cells() const { return recorder.all<MapCell>(); }
  [[nodiscard]] std::vector<MapArrived> maps() const { return recorder.all<MapArrived>(); }

  coupling::SurgeonCoupling law{coupling::DirectSurgeon{{}}};
  test::KeepingRecorder recorder;
  SurgeonControl control{{}, {}, {law, recorder}};
  SurgeonInputs in;
};

TEST(SurgeonControlTest, EachMapIsRecordedOnceAndStaysUntilTheNext) {
  Bench bench;
  const MapReport three{.number = 3, .places = 3, .depth = {5e-3, 4e-3, 6e-3}};
  for (int i = 0; i < 5; ++i) {
    bench.hear(1, three);
    bench.hear(1, {});  // most telegrams say nothing of it
  }
  EXPECT_EQ(bench.control.status().map, three);
  bench.hear(1, {.number = 4, .places = 4});
  ASSERT_EQ(bench.maps().size(), 2U);
  EXPECT_EQ(bench.maps()[0].report, three);
  EXPECT_EQ(bench.maps()[1].report.places, 4U);
}

TEST(SurgeonControlTest, EachCellOfAMapIsRecordedOnce) {
  Bench bench;
  for (int round = 0; round < 3; ++round) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      bench.hear(1, {}, {.number = 3, .index = i, .count = 4, .stiffness = 1.0 + i});
      bench.hear(1, {});
    }
  }
  ASSERT_EQ(bench.cells().size(), 4U);
  EXPECT_EQ(bench.cells()[2].stiffness, 3);
  EXPECT_EQ(bench.cells()[2].at, TimePoint{5ms}) << "as it arrived";
  bench.hear(1, {}, {.number = 4, .index = 2, .count = 4});
  EXPECT_EQ(bench.cells().size(), 5U) << "of another map";
  bench.hear(2, {}, {.number = 4, .index = 2, .count = 4});
  EXPECT_EQ(bench.cells().size(), 6U) << "of another session";
  bench.hear(2, {}, {.number = 4, .index = kMapCellsMax, .count = 4});
  EXPECT_EQ(bench.cells().size(), 6U) << "of no map's";
}

TEST(SurgeonControlTest, AMapOfAnEarlierSessionIsForgotten) {
  Bench bench;
  bench.hear(1, {.number = 3, .places = 3});
  bench.hear(2, {});
  EXPECT_EQ(bench.control.status().map.number, 0U);
}

}  // namespace
}  // namespace palp::surgeon
