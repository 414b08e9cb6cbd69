#include <array>
#include <stdexcept>
#include <string>

#include <wels/codec_api.h>

#include "video/encoders.h"
#include "video/h264_reading.h"

namespace palp::video {
namespace {

constexpr int kBlur = 4;  // [pixels], of a soft frame: an eighth of the bits

void blur(std::vector<std::uint8_t>& plane, int width, int height) {
  for (int top = 0; top + kBlur <= height; top += kBlur) {
    for (int left = 0; left + kBlur <= width; left += kBlur) {
      const auto at = [&](int x, int y) -> std::uint8_t& {
        return plane[static_cast<std::size_t>((top + y) * width + left + x)];
      };
      int sum = 0;
      for (int i = 0; i < kBlur * kBlur; ++i) sum += at(i % kBlur, i / kBlur);
      const auto mean = static_cast<std::uint8_t>(sum / (kBlur * kBlur));
      for (int i = 0; i < kBlur * kBlur; ++i) at(i % kBlur, i / kBlur) = mean;
    }
  }
}

class OpenH264Encoder final : public Encoder {
 public:
  OpenH264Encoder(int width, int height);
  ~OpenH264Encoder() override {
    if (codec_ == nullptr) return;
    (void)codec_->Uninitialize();
    WelsDestroySVCEncoder(codec_);
  }
  OpenH264Encoder(const OpenH264Encoder&) = delete;
  OpenH264Encoder& operator=(const OpenH264Encoder&) = delete;

  std::optional<EncodedFrame> encode(const Picture& picture, const FrameOrder& order) override;
  void acknowledge(const FrameNature& frame) override {
    SLTRMarkingFeedback feedback{};
    feedback.uiFeedbackType = LTR_MARKING_SUCCESS;
    feedback.uiIDRPicId = static_cast<unsigned>(frame.key_id);
    feedback.iLTRFrameNum = frame.marked_frame_num;
    (void)codec_->SetOption(ENCODER_LTR_MARKING_FEEDBACK, &feedback);
  }
  void recover(const FrameNature& held, const FrameNature& newest) override {
    SLTRRecoverRequest request{};
    request.uiFeedbackType = LTR_RECOVERY_REQUEST;
    request.uiIDRPicId = static_cast<unsigned>(held.key_id);
    request.iLastCorrectFrameNum = held.frame_num;
    request.iCurrentFrameNum = newest.frame_num;
    (void)codec_->SetOption(ENCODER_LTR_RECOVERY_REQUEST, &request);
  }

 private:
  void follow(const FrameOrder& order);

  ISVCEncoder* codec_{};
  H264Reading reading_;
  Picture softened_;
  float fps_{30};
  long long number_{};
};

OpenH264Encoder::OpenH264Encoder(int width, int height) {
  const std::string refusal = "OpenH264 refuses pictures of " + std::to_string(width) + " x " +
                              std::to_string(height) + " pixels";
  if (WelsCreateSVCEncoder(&codec_) != 0 || codec_ == nullptr) throw std::runtime_error{refusal};
  int quiet = WELS_LOG_QUIET;
  (void)codec_->SetOption(ENCODER_OPTION_TRACE_LEVEL, &quiet);
  SEncParamExt p{};
  (void)codec_->GetDefaultParams(&p);
  p.iUsageType = CAMERA_VIDEO_REAL_TIME;
  p.iPicWidth = width;
  p.iPicHeight = height;
  p.iTargetBitrate = 1'000'000;  // until the first order
  p.iMaxBitrate = UNSPECIFIED_BIT_RATE;
  p.fMaxFrameRate = fps_;
  p.iRCMode = RC_BITRATE_MODE;
  p.iComplexityMode = LOW_COMPLEXITY;
  p.iTemporalLayerNum = 1;
  p.iSpatialLayerNum = 1;
  p.uiIntraPeriod = 0;
  p.eSpsPpsIdStrategy = CONSTANT_ID;
  p.bEnableFrameSkip = false;
  p.bEnableLongTermReference = true;
  p.iLTRRefNum = 2;
  p.iLtrMarkPeriod = 10;
  p.iNumRefFrame = AUTO_REF_PIC_COUNT;
  p.iMultipleThreadIdc = 1;
  p.bEnableSceneChangeDetect = false;
  p.bEnableAdaptiveQuant = false;
  p.bEnableBackgroundDetection = false;
  p.bEnableDenoise = false;
  auto& layer = p.sSpatialLayers[0];
  layer.iVideoWidth = width;
  layer.iVideoHeight = height;
  layer.fFrameRate = fps_;
  layer.iSpatialBitrate = p.iTargetBitrate;
  layer.iMaxSpatialBitrate = UNSPECIFIED_BIT_RATE;
  layer.uiProfileIdc = PRO_BASELINE;
  // A limit on the size of slices would break its control of the rate.
  layer.sSliceArgument.uiSliceMode = SM_SINGLE_SLICE;
  if (codec_->InitializeExt(&p) != 0) {
    WelsDestroySVCEncoder(codec_);
    throw std::runtime_error{refusal};
  }
}

void OpenH264Encoder::follow(const FrameOrder& order) {
  SBitrateInfo rate{};
  rate.iLayer = SPATIAL_LAYER_ALL;
  rate.iBitrate = static_cast<int>(order.kbps * 1000);
  (void)codec_->SetOption(ENCODER_OPTION_BITRATE, &rate);
  if (auto fps = static_cast<float>(order.fps); fps != fps_) {
    fps_ = fps;
    (void)codec_->SetOption(ENCODER_OPTION_FRAME_RATE, &fps);
  }
  if (order.key && number_ > 0) (void)codec_->ForceIntraFrame(true);
}

std::optional<EncodedFrame> OpenH264Encoder::encode(const Picture& picture,
                                                    const FrameOrder& order) {
  follow(order);
  if (order.soft) {
    softened_ = picture;
    blur(softened_.y, picture.width, picture.height);
    blur(softened_.u, picture.width / 2, picture.height / 2);
    blur(softened_.v, picture.width / 2, picture.height / 2);
  }
  const Picture& shown = order.soft ? softened_ : picture;
  SSourcePicture source{};
  source.iColorFormat = videoFormatI420;
  source.iPicWidth = shown.width;
  source.iPicHeight = shown.height;
  source.iStride[0] = shown.width;
  source.iStride[1] = source.iStride[2] = shown.width / 2;
  // The library only reads them.
  source.pData[0] = const_cast<std::uint8_t*>(shown.y.data());  // NOLINT(*-const-cast)
  source.pData[1] = const_cast<std::uint8_t*>(shown.u.data());  // NOLINT(*-const-cast)
  source.pData[2] = const_cast<std::uint8_t*>(shown.v.data());  // NOLINT(*-const-cast)
  source.uiTimeStamp = static_cast<long long>(static_cast<double>(number_++) * 1000.0 / 30.0);
  SFrameBSInfo info{};
  if (codec_->EncodeFrame(&source, &info) != 0) return std::nullopt;
  EncodedFrame frame;
  for (int i = 0; i < info.iLayerNum; ++i) {
    const SLayerBSInfo& layer = info.sLayerInfo[i];
    std::size_t size = 0;
    for (int unit = 0; unit < layer.iNalCount; ++unit) {
      size += static_cast<std::size_t>(layer.pNalLengthInByte[unit]);
    }
    const auto* bytes = reinterpret_cast<const std::byte*>(layer.pBsBuf);
    frame.bytes.insert(frame.bytes.end(), bytes, bytes + size);
  }
  const auto nature = reading_.read(frame.bytes);
  if (!nature) return std::nullopt;
  frame.nature = *nature;
  return frame;
}

}  // namespace

std::unique_ptr<Encoder> make_h264_encoder(int width, int height) {
  return std::make_unique<OpenH264Encoder>(width, height);
}

}  // namespace palp::video
