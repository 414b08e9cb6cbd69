#include "monitor/offers.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace palp::monitor {
namespace {

std::set<std::string> names_of(const std::vector<Service>& services) {
  std::set<std::string> names;
  for (const Service& one : services) names.insert(one.name);
  return names;
}

TEST(OffersTest, EachNumberIsOneChannelsOnly) {
  CameraFeed camera;
  StudyScreen study;
  for (const link::Role site : {link::Role::Surgeon, link::Role::Patient}) {
    std::set<std::uint32_t> ids;
    std::set<std::string> topics;
    for (const Channel& one : channels_of(site, {.camera = &camera, .study = &study})) {
      EXPECT_TRUE(ids.insert(one.id).second) << one.topic;
      EXPECT_TRUE(topics.insert(one.topic).second) << one.topic;
    }
    EXPECT_TRUE(ids.contains(kStudyChannel) && ids.contains(kCameraChannel));
  }
}

TEST(OffersTest, OnlyWhatThereIsIsOffered) {
  const auto plain = channels_of(link::Role::Surgeon, {});
  EXPECT_FALSE(std::ranges::any_of(plain, [](const Channel& one) {
    return one.id == kCameraChannel || one.id == kStudyChannel;
  }));
  EXPECT_TRUE(services_of({}).empty());
  SpscQueue<Request> requests{4};
  Mailbox<PointerReport> pointer;
  StudyScreen study;
  const std::set<std::string> all = names_of(services_of({.requests = &requests}));
  EXPECT_EQ(all, (std::set<std::string>{"mark", "stop", "reset", "end_session"}));
  const auto more =
      names_of(services_of({.requests = &requests, .pointer = &pointer, .study = &study}));
  EXPECT_TRUE(more.contains("pointer/take") && more.contains("pointer/give"));
  EXPECT_TRUE(more.contains("study/answer"));
}

}  // namespace
}  // namespace palp::monitor
