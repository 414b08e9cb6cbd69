#include "common/io/device/register_port.h"

#include <gtest/gtest.h>

namespace palp::io {
namespace {

TEST(PortFaultTest, EachHasAWordOfItsOwn) {
  EXPECT_TRUE(to_string(PortFault::None).empty());
  EXPECT_EQ(to_string(PortFault::Lost), "connection lost");
  EXPECT_NE(to_string(PortFault::NoReply), to_string(PortFault::Refused));
}

}  // namespace
}  // namespace palp::io
