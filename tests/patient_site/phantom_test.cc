#include "patient_site/phantom.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/own_path.h"

namespace palp::patient {
namespace {

using ::testing::HasSubstr;

TEST(PhantomTest, PaperPhantomsGrowSofterWithDepth) {
  double above = 1;
  for (const char* name : {"paper-5mm", "paper-10mm", "paper-15mm", "paper-20mm", "paper-25mm"}) {
    const auto phantom = make_phantom(name);
    ASSERT_TRUE(phantom) << phantom.error().text;
    EXPECT_EQ(phantom->name, name);
    EXPECT_EQ(phantom->shape, "ball");
    EXPECT_LT(phantom->over.force(3e-3), above);
    EXPECT_GT(phantom->over.force(3e-3), phantom->plain.force(3e-3));
    above = phantom->over.force(3e-3);
  }
}

TEST(PhantomTest, SiteAIsThePlainBlockAndSiteBLiesOverTheInclusion) {
  const auto phantom = make_phantom("paper-5mm");
  ASSERT_TRUE(phantom);
  const auto field = make_field(*phantom, 0);
  for (const double d : {0.5e-3, 2e-3, 4e-3}) {
    EXPECT_EQ(field->elastic_force(kSiteA, d), phantom->plain.force(d));
    EXPECT_EQ(field->elastic_force(kSiteB, d), phantom->over.force(d));
  }
  EXPECT_EQ(*phantom->depth, 5e-3);
}

TEST(PhantomTest, NoneIsPlainEverywhere) {
  const auto phantom = make_phantom("none");
  ASSERT_TRUE(phantom);
  EXPECT_EQ(phantom->plain.force(2e-3), phantom->over.force(2e-3));
  EXPECT_FALSE(phantom->depth);
}

TEST(PhantomTest, ClosedFormIsItsLaw) {
  const auto phantom = make_phantom("closed-form:10");
  ASSERT_TRUE(phantom);
  EXPECT_NEAR(phantom->plain.force(4e-3), 0.480, 0.5e-3);
  EXPECT_NEAR(phantom->plain.derivative(4e-3), 180, 0.5);
  EXPECT_NEAR(phantom->over.derivative(4e-3), 292, 0.5);
  const auto shallow = make_phantom("closed-form");
  ASSERT_TRUE(shallow);
  EXPECT_NEAR(shallow->over.force(3e-3), 0.630, 0.5e-3);
  EXPECT_NEAR(shallow->over.force(3.0033e-3), 0.6309, 1e-3);
}

TEST(PhantomTest, AFileIsSiteBBesideThePapersBlock) {
  const std::string path = test::own_path("phantom_test.csv");
  std::ofstream{path} << "d_mm,F_N\n0,0\n1,0.1\n2,0.3\n4,1\n";
  const auto phantom = make_phantom("file:" + path);
  ASSERT_TRUE(phantom) << phantom.error().text;
  EXPECT_NEAR(phantom->over.force(2e-3), 0.3, 1e-15);
  EXPECT_EQ(phantom->plain.force(2e-3), make_phantom("none")->plain.force(2e-3));
  EXPECT_EQ(phantom->shape, "unknown");
  EXPECT_EQ(phantom->depth_max(), 4e-3);
  EXPECT_THAT(phantom->caution, HasSubstr("beside it the tissue is the paper's block of 15.3 kPa"));
  const auto meant = make_phantom("file:" + path + " beside=paper");
  ASSERT_TRUE(meant) << meant.error().text;
  EXPECT_EQ(meant->caution, "");
  const auto both = make_phantom("file:" + path + " beside=" + path);
  ASSERT_TRUE(both) << both.error().text;
  EXPECT_NEAR(both->plain.force(2e-3), 0.3, 1e-15);
  EXPECT_EQ(both->caution, "");
  EXPECT_THAT(make_phantom("file:" + path + " beside=none.csv").error().text,
              HasSubstr("cannot read none.csv"));
  std::remove(path.c_str());
}

TEST(PhantomTest, AFileMayHoldTheWordsOfATissue) {
  const std::string path = test::own_path("phantom_words.txt");
  const std::string words = "# two balls\nball depth=6 at=20,0\nball depth=9 radius=5 at=-15,0\n";
  std::ofstream{path} << words;
  const auto phantom = make_phantom("file:" + path);
  std::remove(path.c_str());
  ASSERT_TRUE(phantom) << phantom.error().text;
  EXPECT_EQ(phantom->words, words);
  EXPECT_EQ(*phantom->depth, 6e-3);
  ASSERT_TRUE(phantom->block);
  EXPECT_EQ(phantom->block->inclusions.size(), 2U);
  const auto read = parse_tissue_curves(tissue_csv(*phantom), "t", kSiteB);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->size(), 3U) << "A and above each ball";
  EXPECT_NEAR(read->back().table.force(2e-3),
              make_field(*phantom, 0)->elastic_force({-15e-3, 0}, 2e-3),
              1e-8);
}

TEST(PhantomTest, AFileMaySayWhereItsCurvesLie) {
  const std::string path = test::own_path("phantom_places.csv");
  std::ofstream{path} << "x_mm,y_mm,d_mm,F_N\n0,0,0,0\n0,0,1,0.1\n0,0,2,0.3\n0,0,4,1\n"
                      << "5,-2,0,0\n5,-2,1,0.2\n5,-2,2,0.6\n5,-2,3,2\n";
  const auto phantom = make_phantom("file:" + path);
  std::remove(path.c_str());
  ASSERT_TRUE(phantom) << phantom.error().text;
  EXPECT_EQ(phantom->survey.size(), 2U);
  EXPECT_EQ(phantom->caution, "");
  EXPECT_EQ(phantom->depth_max(), 3e-3);
  EXPECT_EQ(phantom->axis, (Place{5e-3, -2e-3}));
  const auto field = make_field(*phantom, 0);
  EXPECT_NEAR(field->elastic_force(kSiteA, 2e-3), 0.3, 1e-12);
  EXPECT_NEAR(field->elastic_force({5e-3, -2e-3}, 2e-3), 0.6, 1e-12);
  const std::string text = tissue_csv(*phantom);
  const auto read = parse_tissue_curves(text, "t", kSiteB);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->size(), 2U);
}

TEST(PhantomTest, ABallLiesWhereItIsAskedFor) {
  const auto phantom = make_phantom("ball depth=8 at=-12.5,3");
  ASSERT_TRUE(phantom) << phantom.error().text;
  EXPECT_NEAR(phantom->axis.x, -12.5e-3, 1e-12);
  EXPECT_NEAR(phantom->axis.y, 3e-3, 1e-12);
  EXPECT_EQ(make_phantom("ball depth=8")->axis, kSiteB);
  for (const char* bad : {"at=3", "at=3,", "at=,3", "at=251,0", "at=nan,0", "at=1,2,3", "at"}) {
    EXPECT_THAT(make_phantom(std::string{"ball depth=8 "} + bad).error().text,
                HasSubstr("is not at=X_MM,Y_MM"))
        << bad;
  }
}

TEST(PhantomTest, UnknownNamesGetOneSentence) {
  EXPECT_THAT(make_phantom("paper-7mm").error().text, HasSubstr("unknown phantom 'paper-7mm'"));
  EXPECT_THAT(make_phantom("").error().text, HasSubstr("unknown phantom"));
  EXPECT_THAT(make_phantom("file:").error().text, HasSubstr("names no file"));
  EXPECT_THAT(make_phantom("file:no.csv").error().text, HasSubstr("cannot read no.csv"));
  for (const char* bad : {"relaxing:1",
                          "exponential:",
                          "closed-form:x",
                          "closed-form:1.9",
                          "closed-form:101",
                          "closed-form:nan"}) {
    EXPECT_THAT(make_phantom(bad).error().text, HasSubstr("from 2 to 100")) << bad;
  }
  EXPECT_TRUE(make_phantom("closed-form:2"));
}

TEST(PhantomTest, TissueTextIsATableThatCanBeReadBack) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  const std::string text = tissue_csv(*phantom);
  EXPECT_THAT(text, ::testing::StartsWith("x_mm,y_mm,d_mm,F_N\n0,0,0,0\n0,0,0.25,"));
  const std::string b = "x_mm,y_mm,d_mm,F_N\n" + text.substr(text.find("20,0,"));
  const auto table = parse_force_table(b, "B");
  ASSERT_TRUE(table) << table.error().text;
  for (int tenths = 0; tenths < 50; ++tenths) {
    const double d = 1e-4 * tenths;
    EXPECT_NEAR(table->force(d), phantom->over.force(d), 1e-8);
  }
}

TEST(PhantomTest, TheExponentialOneStiffensAsFungsLawDoes) {
  const auto phantom = make_phantom("exponential:10");
  ASSERT_TRUE(phantom);
  for (const double depth : {1e-3, 2e-3, 4e-3}) {
    EXPECT_NEAR(phantom->plain.derivative(depth),
                450 * (phantom->plain.force(depth) + 0.08),
                1e-3 * phantom->plain.derivative(depth));
    EXPECT_GT(phantom->over.force(depth), phantom->plain.force(depth));
  }
}

TEST(PhantomTest, TheDrainingOneIsHertzAtFirstAndStiffensTwofold) {
  const auto phantom = make_phantom("draining");
  ASSERT_TRUE(phantom);
  const double hertz = 16.0 / 9 * 8e3 * std::sqrt(5e-3);  // [N/m^1.5], incompressible
  const auto above = [&](double d) { return phantom->plain.force(d) / (hertz * std::pow(d, 1.5)); };
  EXPECT_NEAR(above(2e-5), 1, 0.03);
  EXPECT_NEAR(above(4e-3), 2, 0.5);
}

TEST(PhantomTest, TheLayeredOneIsTwiceAsStiffBelowTheFat) {
  const auto phantom = make_phantom("layered");
  ASSERT_TRUE(phantom);
  const double above = phantom->plain.derivative(1.4e-3);
  EXPECT_NEAR(phantom->plain.derivative(1.5e-3) / above, 1, 0.1);
  EXPECT_GT(phantom->plain.derivative(2.6e-3), 2 * above);
}

TEST(RelaxingForceTest, AHeldTissueLetsGoOfItsShareAndNeverPulls) {
  RelaxingForce tissue{{{Relaxation::Part{.share = 0.1, .time = 1}}}};
  EXPECT_NEAR(tissue.step(1, 1e-4), 1, 1e-4) << "at once it is elastic";
  double force = 0;
  for (int i = 0; i < 10'000; ++i) force = tissue.step(1, 1e-4);
  EXPECT_NEAR(force, 1 - 0.1 * (1 - std::exp(-1)), 1e-4);
  for (int i = 0; i < 90'000; ++i) force = tissue.step(1, 1e-4);
  EXPECT_NEAR(force, 0.9, 1e-4);
  EXPECT_EQ(tissue.step(0.01, 1e-4), 0) << "the tip leaves faster than the tissue follows";
}

TEST(RelaxingForceTest, WhatDrainsLetsGoByTheRootOfTime) {
  constexpr double kTime = 2;  // [s]
  RelaxingForce tissue{stretched_relaxation(0.2, kTime)};
  int tick = 0;
  for (const double until : {0.03, 0.1, 0.5, 2.0, 10.0, 60.0}) {
    double force = 0;
    for (; 1e-4 * tick < until; ++tick) force = tissue.step(1, 1e-4);
    const double at = 1e-4 * tick;
    EXPECT_NEAR(force, 1 - 0.2 * (1 - std::exp(-std::sqrt(at / kTime))), 1e-3) << until;
  }
}

TEST(RelaxingForceTest, WithoutAShareItIsTheElasticForceToTheBit) {
  RelaxingForce tissue{Relaxation{}};
  for (const double elastic : {0.0, 0.3, 1e-9}) EXPECT_EQ(tissue.step(elastic, 1e-4), elastic);
}

}  // namespace
}  // namespace palp::patient
