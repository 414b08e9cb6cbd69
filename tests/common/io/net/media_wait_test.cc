#include "common/io/net/media_wait.h"

#include "common/io/net/datagram_socket.h"
#include "tests/common/io/net/loopback.h"

namespace palp::io {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(MediaWaitTest, EndsWithADatagramOrWithItsSpan) {
  DatagramSocket socket = DatagramSocket::bound(*resolve_endpoint("127.0.0.1:0"));
  test::PlainSocket other;
  const SteadyClock clock;
  const TimePoint began = clock.now();
  wait_for_datagram(socket.descriptor(), milliseconds{20});
  EXPECT_GE(clock.now() - began, milliseconds{20});
  ASSERT_TRUE(other.send_to(socket.local(), test::bytes_of(1, 20)));
  wait_for_datagram(socket.descriptor(), seconds{60});
  EXPECT_LT(clock.now() - began, seconds{30});
  wait_for_datagram(-1, milliseconds{-5});
  EXPECT_LT(clock.now() - began, seconds{30}) << "what is over is over";
}

}  // namespace
}  // namespace palp::io
