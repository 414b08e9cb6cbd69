#include "site_program/session_info.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "site_program/build_info.h"

namespace palp::site_program {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Key;
using testing::Pair;

TEST(SessionInfoTest, SaysWhatTheSessionWasMadeWith) {
  config::Document document = config::surgeon_document();
  ASSERT_TRUE(document.set("hand.grip=firm"));
  const record::SessionInfo info = session_info(link::Role::Surgeon, "palp-surgeon", 7, document);
  EXPECT_EQ(info.site, link::Role::Surgeon);
  EXPECT_THAT(info.metadata, Contains(Pair("program", "palp-surgeon")));
  EXPECT_THAT(info.metadata, Contains(Pair("version", std::string{version()})));
  EXPECT_THAT(info.metadata, Contains(Pair("git_commit", std::string{git_commit()})));
  const std::string protocol = std::to_string(link::kProtocolVersion);
  EXPECT_THAT(info.metadata, Contains(Pair("protocol_version", protocol)));
  EXPECT_THAT(info.metadata, Contains(Pair("seed", "7")));
  EXPECT_THAT(info.metadata, Contains(Pair("time", "real")));
  EXPECT_THAT(info.metadata, Contains(Key("host_kernel")));
  ASSERT_EQ(info.attachments.size(), 1U);
  EXPECT_EQ(info.attachments[0].name, "config.textproto");
  EXPECT_THAT(info.attachments[0].content, HasSubstr("grip: \"firm\""));
}

TEST(SessionInfoTest, TheBuildKnowsItself) {
  EXPECT_FALSE(version().empty());
  EXPECT_FALSE(git_commit().empty());
}

}  // namespace
}  // namespace palp::site_program
