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

TEST(ProfileFlawTest, ThoseOfOursHaveNone) {
  for (const char* const name : {"az", "iai", "orca", "tlb4", "z-sg"}) {
    EXPECT_EQ(flaw(find_profile(name).value()), "none") << name;
  }
}

TEST(ProfileFlawTest, AnAxisIsSentToATargetAndStopped) {
  DeviceProfile profile = find_profile("orca").value();
  profile.stop.reset();
  EXPECT_THAT(flaw(profile), HasSubstr("has no stop"));
  profile = find_profile("orca").value();
  profile.move.front().values.front().source = ValueSource::Constant;
  EXPECT_THAT(flaw(profile), HasSubstr("no target"));
  profile = find_profile("tlb4").value();
  EXPECT_FALSE(profile.stop) << "what does not move needs no stop";
  EXPECT_EQ(flaw(profile), "none");
}

TEST(ProfileFlawTest, NumbersFitTheirKind) {
  const auto with = [](double number, WordKind kind) {
    DeviceProfile profile = find_profile("orca").value();
    profile.start.front().write.values = {{.number = number, .kind = kind}};
    return flaw(profile);
  };
  EXPECT_THAT(with(65'539, WordKind::U16), HasSubstr("cannot hold: 65539"));
  EXPECT_THAT(with(-1, WordKind::U16), HasSubstr("cannot hold"));
  EXPECT_THAT(with(40'000, WordKind::I16), HasSubstr("cannot hold"));
  EXPECT_THAT(with(3e9, WordKind::I32), HasSubstr("cannot hold"));
  EXPECT_THAT(with(1e39, WordKind::F32), HasSubstr("cannot hold"));
  EXPECT_EQ(with(65'535, WordKind::U16), "none");
  EXPECT_EQ(with(-32'768, WordKind::I16), "none");
  EXPECT_EQ(with(4'294'967'295, WordKind::U32), "none");
  EXPECT_EQ(with(0.1, WordKind::F32), "none");
}

TEST(ProfileFlawTest, AConditionCanHold) {
  DeviceProfile profile = find_profile("orca").value();
  profile.healthy[1].mask = 1;
  profile.healthy[1].value = 2;
  EXPECT_THAT(flaw(profile), HasSubstr("register 432 can never hold"));
  profile = find_profile("orca").value();
  profile.start[1].unasked->mask = 0;
  profile.start[1].unasked->value = 5;
  EXPECT_THAT(flaw(profile), HasSubstr("can never hold"));
}

TEST(ProfileFlawTest, SilenceIsLongerThanThePeriod) {
  DeviceProfile profile = find_profile("orca").value();
  profile.silence = profile.period;
  EXPECT_THAT(flaw(profile), HasSubstr("never live"));
}

TEST(ProfileFlawTest, NoTextObeysAsATerminalsCommand) {
  DeviceProfile profile = find_profile("orca").value();
  profile.name = "\033[2JEVIL\nline";
  const std::string said = flaw(profile);
  EXPECT_THAT(said, HasSubstr("a terminal would obey"));
  EXPECT_EQ(said.find_first_of("\033\n"), std::string::npos) << said;
  profile = find_profile("orca").value();
  profile.healthy.front().means = "hot\x1b[31m";
  EXPECT_THAT(flaw(profile), HasSubstr("a terminal would obey"));
  profile = find_profile("orca").value();
  profile.name = "Achse für µm";
  EXPECT_EQ(flaw(profile), "none");
}

}  // namespace
}  // namespace palp::patient
