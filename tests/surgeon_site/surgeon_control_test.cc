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

/// An engaged hand at rest at 0, and a tip that stands at `tip` [m] and measures 1 N.
struct PressBench {
  explicit PressBench(const coupling::DirectConfig& config)
      : law{coupling::DirectSurgeon{config}} {}

  void hear(double tip, int ticks) {
    Incoming sample;
    sample.fresh = true;
    sample.sample.position = tip;
    sample.sample.force = 1;
    for (int i = 0; i < ticks; ++i) {
      in.now += 1ms;
      in.hand.sampled_at = in.now;
      in.arrived.samples = {&sample, 1};
      out = control.step(in);
    }
    in.arrived.samples = {};
  }
  void engage() {
    in.link.state = LinkState::Live;
    in.link.session_id = 1;
    in.arrived.peer_heard = true;
    in.arrived.peer.state = SiteState::Clutched;
    hear(0, 2);
    in.hand.pedal_held = true;
    hear(0, 1);
    in.arrived.peer.state = SiteState::Engaged;
    in.arrived.peer.epoch = 1;
  }

  coupling::SurgeonCoupling law;
  test::KeepingRecorder recorder;
  SurgeonControl control{{}, {}, {law, recorder}};
  SurgeonInputs in;
  SurgeonOutputs out;
};

/// [N], 1 N but for a spring to a tip that stands 1 mm deeper.
coupling::DirectConfig with_spring(double spring) {
  return {.spring = spring, .change = {.slew = 1e9, .at_once = 1e9}};
}

TEST(SurgeonControlTest, ThePeerIsToldTheForceThatTheHandIsGivenNotWhatTheLawWouldGive) {
  PressBench bench{with_spring(1000)};
  bench.engage();
  bench.hear(-2e-3, 120'000);  // motors that are hot stand less
  EXPECT_LT(bench.out.force, 1.5);
  EXPECT_GT(bench.out.force, 1.3);
  EXPECT_EQ(bench.out.to_peer.port.force, bench.out.force);
}

TEST(SurgeonControlTest, AHandThatIsGivenLessThanTheTipMeasuresIsToldAndItIsWrittenDown) {
  PressBench bench{with_spring(300)};
  bench.engage();
  bench.hear(1e-3, 2000);
  ASSERT_EQ(bench.control.status().state, SiteState::Engaged);
  EXPECT_EQ(bench.control.status().shortage, record::NoteCode::TipFeelsMore);
  EXPECT_NEAR(bench.control.status().short_by, 0.3, 0.01);
  const SiteTick tick = bench.recorder.all<SiteTick>().back();
  EXPECT_EQ(tick.short_note, static_cast<std::uint16_t>(record::NoteCode::TipFeelsMore));
  EXPECT_EQ(tick.short_by, bench.control.status().short_by);
  bench.hear(0, 1000);
  EXPECT_EQ(bench.control.status().shortage, record::NoteCode::None);
  std::vector<record::NoteCode> noted;
  for (const Note& note : bench.recorder.all<Note>()) {
    const auto code = static_cast<record::NoteCode>(note.code);
    if (code == record::NoteCode::TipFeelsMore || code == record::NoteCode::ForceComplete) {
      noted.push_back(code);
    }
  }
  EXPECT_EQ(noted, (std::vector{record::NoteCode::TipFeelsMore, record::NoteCode::ForceComplete}));
}

TEST(SurgeonControlTest, AForceThatIsMeantToBeHalfOfTheTipsIsWhole) {
  coupling::DirectConfig half = with_spring(0);
  half.force_scale = 0.5;
  PressBench bench{half};
  bench.engage();
  bench.hear(0, 2000);
  ASSERT_EQ(bench.control.status().state, SiteState::Engaged);
  EXPECT_NEAR(bench.control.status().force, 0.5, 0.01);
  EXPECT_EQ(bench.control.status().shortage, record::NoteCode::None);
}

}  // namespace
}  // namespace palp::surgeon
