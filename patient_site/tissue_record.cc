#include "patient_site/tissue_record.h"

#include "common/config/number.h"
#include "common/core/conventions.h"

namespace palp::patient {

void describe_tissue(const Phantom& phantom,
                     double surface_offset,
                     const MotionGateConfig& gate,
                     record::SessionInfo& info) {
  const auto optional_text = [](const std::optional<double>& value, double unit) {
    return value ? config::number_text(*value / unit) : std::string{};
  };
  info.metadata.emplace_back("surface_offset_mm",
                             config::number_text(surface_offset / kMillimetre));
  info.metadata.emplace_back(kTravelMaxKey, config::number_text(gate.travel_max));
  info.metadata.emplace_back("phantom_name", phantom.name);
  info.metadata.emplace_back("phantom_depth_mm", optional_text(phantom.depth, kMillimetre));
  info.metadata.emplace_back("phantom_radius_mm", optional_text(phantom.radius, kMillimetre));
  info.metadata.emplace_back("phantom_ratio", optional_text(phantom.ratio, 1));
  info.metadata.emplace_back("phantom_shape", phantom.shape);
  info.metadata.emplace_back("phantom_x_mm", config::number_text(phantom.axis.x / kMillimetre));
  info.metadata.emplace_back("phantom_y_mm", config::number_text(phantom.axis.y / kMillimetre));
  info.attachments.push_back({"tissue.csv", "text/csv", tissue_csv(phantom)});
  if (!phantom.words.empty()) {
    info.attachments.push_back({"tissue.txt", "text/plain", phantom.words});
  }
}

}  // namespace palp::patient
