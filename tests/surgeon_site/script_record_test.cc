#include "surgeon_site/script_record.h"

#include <gtest/gtest.h>

#include "surgeon_site/script_source.h"

namespace palp::surgeon {
namespace {

TEST(ScriptRecordTest, AReadyMadeScriptNeedsNoText) {
  record::SessionInfo info;
  describe_script(load_script("script:demo", {}).value(), info);
  EXPECT_TRUE(info.attachments.empty());
  EXPECT_TRUE(is_ready_made("script:demo"));
  EXPECT_TRUE(is_ready_made("script:random:7"));
  EXPECT_FALSE(is_ready_made("script:demo.txt"));
  EXPECT_FALSE(is_ready_made("recording:hand.mcap"));
}

TEST(ScriptRecordTest, WhatAFileSaidIsKept) {
  GestureScript script = load_script("script:demo", {}).value();
  script.set_text("move -2 0.5\n");
  record::SessionInfo info;
  describe_script(script, info);
  ASSERT_EQ(info.attachments.size(), 1U);
  EXPECT_EQ(info.attachments.front().name, kScriptAttachment);
  EXPECT_EQ(info.attachments.front().content, "move -2 0.5\n");
}

}  // namespace
}  // namespace palp::surgeon
