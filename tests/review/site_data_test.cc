#include "review/site_data.h"

#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

TEST(SiteDataTest, CollectsWhatMetricsNeed) {
  const auto session = test::load(test::sample_session());
  EXPECT_EQ(session.surgeon.ticks, 6000u);
  EXPECT_EQ(session.surgeon.links.size(), 60u);
  EXPECT_EQ(session.surgeon.transitions.size(), 1u);
  EXPECT_EQ(session.surgeon.began_at, test::at_ms(0));
  EXPECT_EQ(session.patient.estimates.size(), 6u);
  EXPECT_EQ(session.surgeon.reports.size(), 6u);
  EXPECT_EQ(session.patient.number("surface_offset_mm"), 2);
  EXPECT_EQ(session.patient.number("phantom_name"), std::nullopt);
  EXPECT_EQ(session.patient.number("absent"), std::nullopt);
}

TEST(SiteDataTest, FileOfTheOtherSiteIsRefusedByName) {
  const auto files = test::sample_session();
  const auto wrong = load_site(files.surgeon, "x.mcap", link::Role::Patient);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().text.find("x.mcap"), std::string::npos);
}

TEST(SiteDataTest, OtherFilesAreRefused) {
  const std::string text{"no session"};
  EXPECT_FALSE(load_site(std::as_bytes(std::span{text}), "x", link::Role::Surgeon));
  EXPECT_FALSE(load_site("/nowhere/s.mcap", link::Role::Surgeon));
}

TEST(SiteDataTest, OfListsWithoutEndTheFirstAreKept) {
  record::MemorySink sink;
  {
    record::SessionWriter writer{sink, {.site = link::Role::Surgeon}};
    for (std::size_t i = 0; i < kListMax + 10; ++i) writer.write(Note{.at = test::at_ms(1)});
  }
  const SiteData data = load_site(sink.bytes(), "s", link::Role::Surgeon).value();
  EXPECT_EQ(data.notes.size(), kListMax);
  EXPECT_EQ(data.records, kListMax + 10);
}

}  // namespace
}  // namespace palp::review
