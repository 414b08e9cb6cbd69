#include "review/phase_finder.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "surgeon_site/script_builder.h"

namespace palp::review {
namespace {

TEST(PhaseFinderTest, CountsTheTapsOfEachVisit) {
  surgeon::ScriptBuilder script{300};
  for (const Place& site : {kSiteA, kSiteB, kSiteA}) {
    script.site(site).move(-3e-3, std::chrono::milliseconds{500});
    script.taps(2, 4e-3, std::chrono::seconds{1}, std::chrono::milliseconds{500});
  }
  const surgeon::GestureScript whole = script.build();
  PhaseFinder phases{whole};
  std::vector<std::pair<Site, int>> taps;
  for (const surgeon::Stretch& stretch : whole.stretches()) {
    if (stretch.kind != surgeon::StretchKind::Tap) continue;
    const judge::PhaseTag tag = phases.at(stretch.began_at + stretch.duration / 2, {});
    taps.emplace_back(tag.site, tag.index);
  }
  const std::vector<std::pair<Site, int>> expected{
      {Site::A, 1}, {Site::A, 2}, {Site::B, 1}, {Site::B, 2}, {Site::A, 1}, {Site::A, 2}};
  EXPECT_EQ(taps, expected);
}

}  // namespace
}  // namespace palp::review
