#include "video/encoders.h"

#include <gtest/gtest.h>

#include "video/picture.h"

namespace palp::video {
namespace {

TEST(JpegEncoderTest, KeepsToItsRateWithWholePictures) {
  const auto encoder = make_jpeg_encoder(PhantomPicture::kWidth, PhantomPicture::kHeight);
  if (encoder == nullptr) GTEST_SKIP() << "this build has no libjpeg-turbo";
  PhantomPicture phantom;
  std::size_t bytes = 0;
  int frames = 0;
  for (int i = 0; i < 300; ++i) {  // 10 s
    const auto frame = encoder->encode(phantom.draw({}), {.kbps = 900, .fps = 30});
    if (!frame) continue;
    ++frames;
    bytes += frame->bytes.size();
    EXPECT_TRUE(frame->jpeg && frame->nature.key);
    EXPECT_EQ(frame->bytes.front(), std::byte{0xFF});
  }
  EXPECT_GE(frames, 30);
  EXPECT_LT(static_cast<double>(bytes) * 8 / 10 / 1000, 1000) << "kbit/s";
}

}  // namespace
}  // namespace palp::video
