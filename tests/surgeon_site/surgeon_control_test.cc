#include "surgeon_site/surgeon_control.h"

#include <gtest/gtest.h>

#include "tests/support/fake_recorder.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;

/// A site whose inputs a test makes up.
struct Bench {
  void hear(std::uint64_t session, const MapReport& map) {
    in.now += 1ms;
    in.hand.sampled_at = in.now;
    in.link.state = LinkState::Live;
    in.link.session_id = session;
    in.arrived.peer_heard = true;
    in.arrived.peer.map = map;
    (void)control.step(in);
  }
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

TEST(SurgeonControlTest, AMapOfAnEarlierSessionIsForgotten) {
  Bench bench;
  bench.hear(1, {.number = 3, .places = 3});
  bench.hear(2, {});
  EXPECT_EQ(bench.control.status().map.number, 0U);
}

}  // namespace
}  // namespace palp::surgeon
