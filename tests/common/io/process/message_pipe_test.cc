#include "common/io/process/message_pipe.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace palp::io {
namespace {

TEST(MessagePipeTest, CarriesWholeMessagesBothWaysInOrder) {
  auto ends = MessagePipe::make();
  ASSERT_TRUE(ends);
  auto& [one, other] = *ends;
  EXPECT_FALSE(one.send(""));
  EXPECT_FALSE(other.receive());
  EXPECT_TRUE(one.send("first"));
  EXPECT_TRUE(one.send("second"));
  EXPECT_TRUE(other.send("back"));
  EXPECT_EQ(other.receive(), "first");
  EXPECT_EQ(other.receive(), "second");
  EXPECT_FALSE(other.receive());
  EXPECT_TRUE(other.open());
  EXPECT_EQ(one.receive(), "back");
}

TEST(MessagePipeTest, AnEndThatDoesNotReadStopsNobody) {
  auto ends = MessagePipe::make();
  ASSERT_TRUE(ends);
  const std::string message(1000, 'x');
  int sent = 0;
  while (ends->first.send(message) && sent < 100'000) ++sent;
  EXPECT_GT(sent, 0);
  EXPECT_LT(sent, 100'000);
  EXPECT_TRUE(ends->first.open());
}

TEST(MessagePipeTest, AnEndThatIsGoneIsToldOnceAllWasRead) {
  auto ends = MessagePipe::make();
  ASSERT_TRUE(ends);
  MessagePipe here = std::move(ends->second);
  {
    const MessagePipe gone = std::move(ends->first);
    EXPECT_TRUE(MessagePipe{std::move(ends->first)}.number() < 0);
    MessagePipe writes = MessagePipe::adopt(::dup(gone.number())).value();
    EXPECT_TRUE(writes.send("last"));
  }
  EXPECT_EQ(here.receive(), "last");
  EXPECT_TRUE(here.open());
  EXPECT_FALSE(here.receive());
  EXPECT_FALSE(here.open());
  EXPECT_FALSE(here.send("nobody"));
}

TEST(MessagePipeTest, AnotherDescriptorIsNone) {
  EXPECT_FALSE(MessagePipe::adopt(0));
  EXPECT_FALSE(MessagePipe::adopt(900));
}

}  // namespace
}  // namespace palp::io
