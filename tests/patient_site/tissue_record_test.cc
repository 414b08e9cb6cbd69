#include "patient_site/tissue_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::patient {
namespace {

using testing::Contains;
using testing::Pair;

record::SessionInfo described(std::string_view phantom) {
  record::SessionInfo info;
  MotionGateConfig gate;
  gate.travel_max = 0.0123;
  describe_tissue(*make_phantom(phantom), 1.7e-3, gate, info);
  return info;
}

TEST(TissueRecordTest, SaysWhatTheTissueIsInTheUnitsOfItsNames) {
  const record::SessionInfo info = described("paper-10mm");
  EXPECT_THAT(info.metadata, Contains(Pair("surface_offset_mm", "1.7")));
  EXPECT_THAT(info.metadata, Contains(Pair("phantom_name", "paper-10mm")));
  EXPECT_THAT(info.metadata, Contains(Pair("phantom_depth_mm", "10")));
  EXPECT_THAT(info.metadata, Contains(Pair("phantom_radius_mm", "15")));
  EXPECT_THAT(info.metadata, Contains(Pair("phantom_shape", "ball")));
  EXPECT_THAT(info.metadata, Contains(Pair(kTravelMaxKey, "0.0123")));
  ASSERT_EQ(info.attachments.size(), 1U);
  EXPECT_EQ(info.attachments[0].name, "tissue.csv");
}

TEST(TissueRecordTest, LeavesEmptyWhatThereIsNot) {
  EXPECT_THAT(described("none").metadata, Contains(Pair("phantom_depth_mm", "")));
}

}  // namespace
}  // namespace palp::patient
