#include "patient_site/estimator_worker.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

class ListRecorder final : public record::Recorder {
 public:
  bool record(const Record& record) noexcept override {
    records.push_back(record);
    return accept;
  }
  std::vector<Record> records;
  bool accept{true};
};

struct Bench {
  SpscQueue<ContactSample> contact{4096};
  Mailbox<Findings> found;
  Mailbox<MapCells> cells;
  ListRecorder recorder;
  EstimatorWorker worker{{}, {contact, found, cells, recorder}};

  void press() {
    const auto phantom = make_phantom("paper-10mm");
    SimulatedPhantomConfig config = ideal_sensor();
    config.start_position = -3e-3;
    config.start_place = kSiteB;
    SimulatedPhantom site{*phantom, config};
    TimePoint now{};
    for (int i = 0; i < 1200; ++i) {
      now += std::chrono::milliseconds{1};
      const StageState stage = site.read(now);
      contact.try_enqueue({now, stage.position, site.sample(now)->force, stage.place});
      const double t = std::min(i * 1e-3, 1.0);
      site.move_to({-3e-3 + 3.5e-3 * (1 - std::cos(2 * std::numbers::pi * t)), kSiteB});
    }
  }
};

TEST(EstimatorWorkerTest, PutsAndRecordsEachEstimate) {
  Bench bench;
  EXPECT_EQ(bench.found.get().depth.number, 0U);
  bench.press();
  EXPECT_EQ(bench.worker.drain(), 1200U);
  EXPECT_EQ(bench.worker.drain(), 0U);
  EXPECT_EQ(bench.found.get().depth.number, 1U);
  EXPECT_EQ(bench.found.get().depth.verdict, DepthVerdict::Found);
  EXPECT_EQ(bench.worker.strokes(), 1U);
  ASSERT_EQ(bench.recorder.records.size(), 1U);
  EXPECT_EQ(bench.worker.records(), 1U);
  EXPECT_EQ(std::get<DepthEstimate>(bench.recorder.records[0]).number, 1U);
}

TEST(EstimatorWorkerTest, StrokesAtThreePlacesMakeAMapBesideTheDepths) {
  Bench bench;
  const auto phantom = make_phantom("ball depth=5 radius=12 ratio=300 at=0,0");
  TimePoint now{};
  for (const Place& place : {Place{}, Place{10e-3, 0}, Place{0, 10e-3}}) {
    now = feel_taps(*phantom, {}, {.taps = 1, .place = place}, now, [&](const ContactSample& one) {
      bench.contact.try_enqueue(one);
    });
    (void)bench.worker.drain();
    bench.worker.judge_map();
  }
  bench.worker.judge_map();
  const auto cells = bench.recorder.records.size() - 4;
  EXPECT_GT(cells, 50U);
  const auto& last = std::get<MapCell>(bench.recorder.records.back());
  EXPECT_EQ(last.number, 3U);
  const MapCells& told = bench.cells.get();
  ASSERT_EQ(told.count, cells);
  EXPECT_EQ(last.count, cells);
  for (std::uint32_t i = 0; i < told.count; ++i) EXPECT_EQ(told.all.at(i).index, i);
  EXPECT_EQ(last.at, std::get<DepthEstimate>(bench.recorder.records[2]).stroke_ended_at);
  const auto& map = std::get<MapEstimate>(bench.recorder.records[3]);
  EXPECT_EQ(map.report.number, 3U);
  EXPECT_EQ(map.at, std::get<DepthEstimate>(bench.recorder.records[2]).stroke_ended_at);
  EXPECT_EQ(bench.found.get().map, map.report);
  EXPECT_EQ(bench.found.get().depth.number, 3U);
}

TEST(EstimatorWorkerTest, CountsWhatTheRecorderRefuses) {
  Bench bench;
  bench.recorder.accept = false;
  bench.press();
  (void)bench.worker.drain();
  EXPECT_EQ(bench.worker.records(), 0U);
  EXPECT_EQ(bench.worker.records_lost(), bench.recorder.records.size());
  EXPECT_EQ(bench.found.get().depth.number, 1U) << "the estimate itself is not lost";
}

}  // namespace
}  // namespace palp::patient
