// Goal: a changed source is noticed, and only a changed one.
// Method: the kernel's own choice towards loopback addresses; real changes of addresses are made by
// tests/system/own_addresses.
#include "common/io/net/source_watch.h"

#include <gtest/gtest.h>

namespace palp::io {
namespace {

const Endpoint kPeer = *resolve_endpoint("127.0.0.1:9");

TEST(SourceWatchTest, TheKernelNamesWhereItWouldSendFrom) {
  const Endpoint source = source_towards(kPeer);
  ASSERT_TRUE(source.valid());
  EXPECT_TRUE(source.same_host(*resolve_endpoint("127.0.0.1:1")));
  EXPECT_FALSE(source_towards(*resolve_endpoint("255.255.255.255:9")).valid())
      << "not without leave";
}

TEST(SourceWatchTest, AnotherAddressIsAChangeAndAnotherPortIsNone) {
  TimePoint now{std::chrono::seconds{1}};
  SourceWatch watch;
  EXPECT_FALSE(watch.has_changed(now)) << "nothing is connected";
  watch.begin(*resolve_endpoint("127.0.0.1:5"), kPeer);
  EXPECT_FALSE(watch.has_changed(now += SourceWatch::kPause));
  watch.begin(*resolve_endpoint("127.0.0.2:5"), kPeer);
  EXPECT_TRUE(watch.has_changed(now += SourceWatch::kPause));
}

TEST(SourceWatchTest, WithoutAWayTheOldSocketStays) {
  SourceWatch watch;
  watch.begin(*resolve_endpoint("127.0.0.1:5"), *resolve_endpoint("255.255.255.255:9"));
  EXPECT_FALSE(watch.has_changed(TimePoint{std::chrono::seconds{1}}));
}

}  // namespace
}  // namespace palp::io
