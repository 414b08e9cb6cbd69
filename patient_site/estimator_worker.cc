#include "patient_site/estimator_worker.h"

namespace palp::patient {
namespace {

// Of the air before contact: enough to see how the surface was found.
constexpr double kAirRecorded = 1e-3;  // [m]

}  // namespace

EstimatorWorker::EstimatorWorker(const estimator::DepthEstimatorConfig& config, Parts parts)
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
  parts_.depth.put(estimate);
  const bool surface_known = estimate.indentation_max > 0;
  for (const estimator::StrokeSample& sample : estimator_.stroke()) {
    if (surface_known && sample.position < estimate.surface - kAirRecorded) continue;
    record(sample.measured);
  }
  record(estimate);
}

void EstimatorWorker::record(const Record& record) {
  if (parts_.recorder.record(record)) {
    ++records_;
  } else {
    ++records_lost_;
  }
}

}  // namespace palp::patient
