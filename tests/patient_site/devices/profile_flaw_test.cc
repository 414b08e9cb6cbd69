#include "patient_site/devices/profile_flaw.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patient_site/settings_devices.h"

namespace palp::patient {
namespace {

using testing::HasSubstr;

std::string flaw(const DeviceProfile& profile) { return flaw_of(profile, {}).value_or("none"); }

TEST(ProfileFlawTest, NamesWhatIsNotRead) {
  DeviceProfile profile = find_profile("iai").value();
  EXPECT_EQ(flaw(profile), "none");
  profile.position->address = 0x9009;
  EXPECT_THAT(flaw(profile), HasSubstr("position"));
  profile = find_profile("iai").value();
  profile.healthy[0].address = 7;
  EXPECT_THAT(flaw(profile), HasSubstr("state"));
  profile = find_profile("iai").value();
  profile.start[1].unasked->address = 7;
  EXPECT_THAT(flaw(profile), HasSubstr("condition of its start"));
  profile = find_profile("tlb4").value();
  profile.force->negative->address = 7000;
  EXPECT_THAT(flaw(profile), HasSubstr("sign"));
  profile = find_profile("iai").value();
  profile.read_count = 126;
  EXPECT_THAT(flaw(profile), HasSubstr("125"));
}

TEST(ProfileFlawTest, OneRequestCannotReadAndWriteTwice) {
  DeviceProfile profile = find_profile("orca").value();
  EXPECT_EQ(flaw(profile), "none");
  profile.move.push_back(profile.move.front());
  EXPECT_THAT(flaw(profile), HasSubstr("exchanges"));
}

}  // namespace
}  // namespace palp::patient
