#include "patient_site/estimator_worker.h"

namespace palp::patient {

EstimatorWorker::EstimatorWorker(const depth::DepthEstimatorConfig& config, Parts parts)
    : estimator_{config}, parts_{parts} {}

std::size_t EstimatorWorker::drain() {
  std::size_t count = 0;
  ContactSample sample;
  while (parts_.contact.try_dequeue(sample)) {
    ++count;
    if (const auto estimate = estimator_.add(sample)) {
      reversal_at_ = sample.at;
      publish(*estimate);
    }
  }
  return count;
}

void EstimatorWorker::publish(const DepthEstimate& estimate) {
  ++strokes_;
  found_.depth = estimate;
  parts_.found.put(found_);
  record(estimate);
}

void EstimatorWorker::judge_map() {
  const auto map = estimator_.map();
  if (!map) return;
  found_.map = *map;
  parts_.found.put(found_);
  record(MapEstimate{.at = found_.depth.stroke_ended_at, .report = *map});
  cells_.count = 0;
  for (MapCell& cell : estimator_.map_cells()) {
    cell.at = found_.depth.stroke_ended_at;
    record(cell);
    cells_.all.at(cells_.count++) = cell;
  }
  parts_.cells.put(cells_);
}

void EstimatorWorker::record(const Record& record) {
  if (parts_.recorder.record(record)) {
    ++records_;
  } else {
    ++records_lost_;
  }
}

}  // namespace palp::patient
