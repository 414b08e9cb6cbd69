#include "review/lack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "review/recover.h"
#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Bytes = std::vector<std::byte>;

std::string lack(const record::FileBytes& file) {
  record::SessionReader reader{file};
  while (reader.next()) {
  }
  return lack_of(reader);
}

Bytes recovered(const Bytes& file) {
  record::MemorySink out;
  EXPECT_TRUE(recover(file, out));
  return test::bytes_of(out);
}

Bytes whole() { return test::sample_session().surgeon; }
Bytes cut_off() {
  Bytes file = whole();
  file.resize(file.size() * 2 / 3);
  return file;
}
Bytes damaged() {
  Bytes file = whole();
  file[file.size() / 2] ^= std::byte{4};
  return file;
}

TEST(LackTest, AWholeFileLacksNothing) { EXPECT_EQ(lack(whole()), ""); }

TEST(LackTest, WhatIsMissingIsToldBeforeARecoveryAndAfterIt) {
  EXPECT_EQ(lack(cut_off()), "was not closed, and lacks what came after its last message");
  EXPECT_THAT(lack(recovered(cut_off())), HasSubstr("was recovered from one that was not closed"));
  EXPECT_THAT(lack(damaged()),
              AllOf(HasSubstr("has 1 chunks that cannot be read"),
                    HasSubstr("messages"),
                    Not(HasSubstr("closed"))));
  EXPECT_THAT(
      lack(recovered(damaged())),
      AllOf(HasSubstr("was recovered from a damaged one, lacks 1 chunks"), HasSubstr("messages")));
}

}  // namespace
}  // namespace palp::review
