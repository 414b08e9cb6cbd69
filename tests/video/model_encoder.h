#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "common/core/random.h"
#include "video/encoder.h"

namespace palp::video {

/// An encoder of sizes: it keeps to its rate as OpenH264 does and marks and uses long-term
/// references as that does, the third and later marks for the frame before. A frame begins with its
/// own number and that of the frame it truly refers to.
class ModelEncoder final : public Encoder {
 public:
  static constexpr std::uint32_t kNothing = 0xFFFFFFFFU;
  struct Head {
    std::uint32_t number{};
    std::uint32_t refers_to{kNothing};
  };

  explicit ModelEncoder(std::uint64_t seed) : random_{seed, 7} {}

  std::optional<EncodedFrame> encode(const Picture& /*picture*/, const FrameOrder& order) override {
    EncodedFrame frame;
    Head head{.number = number_};
    double size = order.kbps * 125 / order.fps * std::exp(0.25 * random_.normal(number_) - 0.03);
    if (order.key) {
      frame.nature.key = true;
      frame.nature.marks = true;
      frame_num_ = 0;
      marks_ = 1;
      ++key_id_;
      frames_.clear();
      size = order.soft ? 6000 : 40000;
    } else if (recovers_ && acknowledged_) {
      frame.nature.refers_to_long_term = true;
      head.refers_to = *acknowledged_;
      size = 4000;
    } else {
      head.refers_to = number_ - 1;
    }
    recovers_ = false;
    frame.nature.frame_num = frame.nature.marked_frame_num = frame_num_;
    frame.nature.key_id = key_id_;
    frames_[frame_num_] = number_;
    if (!order.key && frame_num_ % 10 == 0) {
      frame.nature.marks = true;
      if (++marks_ >= 3) frame.nature.marked_frame_num = frame_num_ - 1;
    }
    ++frame_num_;
    ++number_;
    frame.bytes.resize(static_cast<std::size_t>(std::max(size, 100.0)));
    std::memcpy(frame.bytes.data(), &head, sizeof head);
    for (std::size_t i = sizeof head; i < frame.bytes.size(); ++i) {
      frame.bytes[i] = expected(head.number, i);
    }
    return frame;
  }
  void acknowledge(const FrameNature& frame) override {
    if (frame.key_id == key_id_) acknowledged_ = frames_[frame.marked_frame_num];
  }
  void recover(const FrameNature& /*held*/, const FrameNature& /*newest*/) override {
    recovers_ = true;
  }

  [[nodiscard]] static std::byte expected(std::uint32_t number, std::size_t at) noexcept {
    return static_cast<std::byte>((std::size_t{number} * 31U + at * 7U) & 0xFFU);
  }

 private:
  RandomStream random_;
  std::uint32_t number_{};
  int frame_num_{};
  int marks_{};
  int key_id_{};
  bool recovers_{};
  std::map<int, std::uint32_t> frames_;  ///< by frame_num
  std::optional<std::uint32_t> acknowledged_;
};

/// Whether each frame is whole and what it refers to was there.
class ModelDecoder {
 public:
  [[nodiscard]] bool decode(const Bytes& frame) {
    ModelEncoder::Head head;
    if (frame.size() < sizeof head) return false;
    std::memcpy(&head, frame.data(), sizeof head);
    for (std::size_t i = sizeof head; i < frame.size(); ++i) {
      if (frame[i] != ModelEncoder::expected(head.number, i)) return false;
    }
    if (head.refers_to != ModelEncoder::kNothing && !had_.contains(head.refers_to)) return false;
    had_[head.number] = true;
    return true;
  }

 private:
  std::map<std::uint32_t, bool> had_;
};

}  // namespace palp::video
