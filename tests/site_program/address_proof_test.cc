#include "site_program/address_proof.h"

#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

using std::chrono::milliseconds;

const io::Endpoint kHere = *io::resolve_endpoint("127.0.0.1:1000");
const io::Endpoint kThief = *io::resolve_endpoint("127.0.0.1:1001");
constexpr TimePoint kNow{std::chrono::seconds{100}};

AddressProof proof() {
  return AddressProof{[number = std::uint64_t{10}]() mutable { return number += 10; }};
}

TEST(AddressProofTest, AnAddressCountsOnceItHasRepeatedItsQuestion) {
  AddressProof one = proof();
  const auto question = one.hear(kHere, 0, kNow);
  ASSERT_TRUE(question);
  EXPECT_FALSE(one.proven().valid());
  EXPECT_EQ(one.hear(kHere, *question + 1, kNow + milliseconds{200}), question) << "asked again";
  EXPECT_FALSE(one.proven().valid());
  EXPECT_FALSE(one.hear(kHere, *question, kNow + milliseconds{300}));
  EXPECT_EQ(one.proven(), kHere);
}

TEST(AddressProofTest, IsAskedTenTimesASecondAtMost) {
  AddressProof one = proof();
  EXPECT_TRUE(one.hear(kHere, 0, kNow));
  EXPECT_FALSE(one.hear(kHere, 0, kNow + AddressProof::kAskEvery - Duration{1}));
  EXPECT_TRUE(one.hear(kHere, 0, kNow + AddressProof::kAskEvery));
}

TEST(AddressProofTest, TheAnswerOfOneAddressProvesNoOther) {
  AddressProof one = proof();
  const auto question = one.hear(kHere, 0, kNow);
  EXPECT_TRUE(one.hear(kThief, *question, kNow));
  EXPECT_FALSE(one.proven().valid());
  EXPECT_TRUE(one.hear(kHere, *question, kNow)) << "a question serves once";
  EXPECT_FALSE(one.proven().valid());
}

TEST(AddressProofTest, WhoIsHeardIsLeftForNobody) {
  AddressProof one = proof();
  (void)one.hear(kHere, *one.hear(kHere, 0, kNow), kNow);
  EXPECT_FALSE(one.hear(kThief, 0, kNow + AddressProof::kSilence));
  EXPECT_FALSE(one.silent(kNow + AddressProof::kSilence));
  const TimePoint later = kNow + AddressProof::kSilence + Duration{1};
  EXPECT_TRUE(one.silent(later));
  const auto question = one.hear(kThief, 0, later);
  ASSERT_TRUE(question) << "who is silent may have moved";
  EXPECT_EQ(one.proven(), kHere) << "and is not left before the other has answered";
  (void)one.hear(kThief, *question, later);
  EXPECT_EQ(one.proven(), kThief);
}

}  // namespace
}  // namespace palp::site_program
