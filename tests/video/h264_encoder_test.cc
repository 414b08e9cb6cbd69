#include <cmath>

#include <gtest/gtest.h>
#include <wels/codec_api.h>

#include "tests/video/tip_reading.h"
#include "tests/video/video_path.h"
#include "video/encoders.h"
#include "video/picture.h"

namespace palp::video {
namespace {

/// A tip that taps, as a function of time.
Scene tapping(Duration at) {
  const double t = seconds(at);
  return {.x = 0.01 * std::sin(0.5 * t), .depth = 0.003 * std::sin(3 * t), .surface = 0};
}

/// By another program than the encoder, but the same library.
class Decoder {
 public:
  Decoder() {
    EXPECT_EQ(WelsCreateDecoder(&codec_), 0);
    SDecodingParam parameters{};
    parameters.eEcActiveIdc = ERROR_CON_DISABLE;
    parameters.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
    (void)codec_->Initialize(&parameters);
  }
  ~Decoder() {
    (void)codec_->Uninitialize();
    WelsDestroyDecoder(codec_);
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  std::optional<TipInPicture> tip_of(const Bytes& frame) {
    unsigned char* planes[3]{};
    SBufferInfo info{};
    const auto* bytes = reinterpret_cast<const unsigned char*>(frame.data());
    if (codec_->DecodeFrameNoDelay(bytes, static_cast<int>(frame.size()), planes, &info) != 0 ||
        info.iBufferStatus != 1) {
      return std::nullopt;
    }
    Picture picture{PhantomPicture::kWidth, PhantomPicture::kHeight};
    const auto stride = static_cast<std::size_t>(info.UsrData.sSystemBuffer.iStride[1]);
    picture.u.assign(planes[1], planes[1] + stride * PhantomPicture::kHeight / 2);
    return read_tip(picture, stride);
  }

 private:
  ISVCDecoder* codec_{};
};

struct Case {
  const char* name;
  const char* words;
};
class H264ThroughLosses : public ::testing::TestWithParam<Case> {};

/// Goal: what is shown is what was seen, at the instant of the capture, whatever was lost. Method:
/// a drawn phantom through encoder, emulated path and decoder; the tip is read back from pixels.
TEST_P(H264ThroughLosses, TheTipIsWhereItWasAtTheCapture) {
  VideoPathSetup setup = video_path(GetParam().words, std::chrono::microseconds{37'500}, 10);
  setup.length = std::chrono::seconds{12};
  const auto encoder = make_h264_encoder(PhantomPicture::kWidth, PhantomPicture::kHeight);
  ASSERT_NE(encoder, nullptr);
  PhantomPicture phantom;
  Decoder decoder;
  double most = 0;
  const VideoPathResult result = run_video_path(
      setup,
      *encoder,
      [&](std::uint32_t, Duration at) -> const Picture& { return phantom.draw(tapping(at)); },
      [&](const ReceivedFrame& frame) {
        const auto tip = decoder.tip_of(frame.bytes);
        if (!tip) return false;
        const Scene scene = tapping(frame.captured);
        // The first second is coarse: key frames are small.
        if (frame.captured > std::chrono::seconds{2}) {
          most = std::max(most, std::hypot(tip->x - scene.x, tip->depth - scene.depth));
        }
        return true;
      });
  EXPECT_EQ(result.wrong, 0U);
  EXPECT_GT(result.received.delivered, 200U);
  EXPECT_LT(most, 0.0003) << "[m]";
  RecordProperty("tip_off_um", static_cast<int>(most * 1e6));
}

INSTANTIATE_TEST_SUITE_P(Losses,
                         H264ThroughLosses,
                         ::testing::Values(Case{"None", ""}, Case{"FivePercent", "loss 5%"}),
                         [](const auto& one) { return std::string{one.param.name}; });

TEST(H264EncoderTest, AKeyFrameIsSmall) {
  const auto encoder = make_h264_encoder(PhantomPicture::kWidth, PhantomPicture::kHeight);
  ASSERT_NE(encoder, nullptr);
  PhantomPicture phantom;
  const auto frame =
      encoder->encode(phantom.draw({}), {.kbps = 200, .fps = 30, .key = true, .soft = true});
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->nature.key);
  EXPECT_LT(frame->bytes.size(), 15'000U);
}

TEST(H264EncoderTest, ASizeThatItCannotTakeIsASentence) {
  EXPECT_THROW((void)make_h264_encoder(0, 0), std::runtime_error);
}

}  // namespace
}  // namespace palp::video
