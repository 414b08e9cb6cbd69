#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>

#include <turbojpeg.h>

#include "video/encoders.h"

namespace palp::video {
namespace {

constexpr int kQualityMin = 15;
constexpr int kQualityMax = 85;
constexpr double kPatience = 0.5;  // [s], credit that is kept

class JpegEncoder final : public Encoder {
 public:
  JpegEncoder() : codec_{tjInitCompress()} {
    if (codec_ == nullptr) throw std::runtime_error{"libjpeg-turbo does not start"};
  }
  ~JpegEncoder() override {
    tjFree(buffer_);
    (void)tjDestroy(codec_);
  }
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  std::optional<EncodedFrame> encode(const Picture& picture, const FrameOrder& order) override;
  void acknowledge(const FrameNature& /*frame*/) override {}
  void recover(const FrameNature& /*held*/, const FrameNature& /*newest*/) override {}

 private:
  tjhandle codec_;
  unsigned char* buffer_{};
  unsigned long room_{};  // NOLINT(google-runtime-int): the library's
  double credit_{};       ///< [bytes]
  int quality_{40};
};

std::optional<EncodedFrame> JpegEncoder::encode(const Picture& picture, const FrameOrder& order) {
  const double rate = order.kbps * 125;  // [bytes/s]
  credit_ = std::min(credit_ + rate / order.fps, rate * kPatience);
  if (credit_ < 0) return std::nullopt;
  const std::array<const unsigned char*, 3> planes{
      picture.y.data(), picture.u.data(), picture.v.data()};
  auto size = room_;
  if (tjCompressFromYUVPlanes(codec_,
                              const_cast<const unsigned char**>(planes.data()),
                              picture.width,
                              nullptr,
                              picture.height,
                              TJSAMP_420,
                              &buffer_,
                              &size,
                              quality_,
                              0) != 0) {
    return std::nullopt;
  }
  room_ = std::max(room_, size);
  credit_ -= static_cast<double>(size);
  // Five to ten frames a second are worth more than detail.
  const double wanted = rate / 7;
  quality_ += static_cast<double>(size) > wanted ? -3 : 1;
  quality_ = std::clamp(quality_, kQualityMin, kQualityMax);
  EncodedFrame frame;
  frame.jpeg = true;
  frame.nature.key = true;
  const auto* bytes = reinterpret_cast<const std::byte*>(buffer_);
  frame.bytes.assign(bytes, bytes + size);
  return frame;
}

}  // namespace

std::unique_ptr<Encoder> make_jpeg_encoder(int /*width*/, int /*height*/) {
  return std::make_unique<JpegEncoder>();
}

}  // namespace palp::video
