// Input: what comes to the video's two ends, opened already, a script: how long after the last, and
// either any bytes, or a fragment whose numbers are near those of others.
#include <array>
#include <optional>
#include <set>
#include <string>

#include "common/core/check.h"
#include "tests/fuzz/fuzz.h"
#include "video/receiver.h"
#include "video/sender.h"

namespace palp::video {
namespace {

using fuzz::ByteSource;

/// Frames of a few bytes, as ordered.
class SmallEncoder final : public Encoder {
 public:
  std::optional<EncodedFrame> encode(const Picture& /*picture*/, const FrameOrder& order) override {
    EncodedFrame frame;
    frame.nature.key = order.key;
    frame.nature.marks = ++frames_ % 10 == 0;
    frame.bytes.assign(3000, std::byte{7});
    return frame;
  }
  void acknowledge(const FrameNature& /*frame*/) override {}
  void recover(const FrameNature& /*held*/, const FrameNature& /*newest*/) override {}

 private:
  int frames_{};
};

Bytes near_fragment(ByteSource& input) {
  static const std::array<std::byte, kFragmentDataMax> kData{};
  Fragment one;
  one.key = input.below(4) == 0;
  one.frame = static_cast<std::uint32_t>(input.below(32));
  one.refers_back = static_cast<std::uint16_t>(one.key ? 0 : 1 + input.below(3));
  one.data_count = static_cast<std::uint8_t>(1 + input.below(4));
  one.parity_count = static_cast<std::uint8_t>(input.below(3));
  one.index = static_cast<std::uint8_t>(input.below(8));
  one.size = 1U + input.take<std::uint16_t>() % 4000U;
  one.offset_us = static_cast<std::uint16_t>(input.below(256) * 100);
  const std::size_t each = (one.size + one.data_count - 1U) / one.data_count;
  one.data = std::span{kData}.first(std::min(each, kFragmentDataMax));
  return write(one);
}

/// What is read is written alike.
void check_form(std::span<const std::byte> bytes) {
  const auto message = read_media(bytes);
  if (!message) return;
  const Bytes again = std::visit([](const auto& one) { return write(one); }, *message);
  PALP_CHECK(std::ranges::equal(again, bytes), "what is read is written alike");
}

void run(ByteSource input) {
  Receiver receiver;
  SmallEncoder encoder;
  Sender sender{{}, encoder};
  const Picture picture{16, 16};
  std::optional<std::uint32_t> newest;
  bool begun = false;
  TimePoint now{std::chrono::seconds{1}};
  while (!input.empty()) {
    now += std::chrono::milliseconds{input.below(64)};
    Bytes bytes;
    if (input.below(2) == 0) {
      const auto any = input.take_bytes(input.below(256));
      bytes.assign(any.begin(), any.end());
    } else {
      bytes = near_fragment(input);
    }
    check_form(bytes);
    if (const auto frame = receiver.hear(bytes, now)) {
      PALP_CHECK(begun || frame->key, "the first frame refers to nothing");
      PALP_CHECK(!newest || frame->number > *newest, "frames come in order, each once");
      PALP_CHECK(!frame->bytes.empty() && frame->bytes.size() <= kFrameSizeMax, "a frame's size");
      newest = frame->number;
      begun = true;
    }
    const Report report = receiver.report({});
    PALP_CHECK(report.newest_delivered == newest.value_or(Report::kNone), "what it says it got");
    // A liar's report to the other end.
    if (const auto message = read_media(bytes)) {
      if (const auto* lie = std::get_if<Report>(&*message)) sender.hear(*lie, {}, now);
    }
    if (sender.wants_picture(now)) (void)sender.take(picture, now.time_since_epoch(), now);
    while (const auto payload = sender.next(now)) {
      PALP_CHECK(read_media(*payload).has_value(), "what is sent keeps its form");
    }
    PALP_CHECK(sender.rate().target() > 0 && sender.rate().target() <= RateConfig{}.max_kbps,
               "no report drives the rate out of its bounds");
  }
}

}  // namespace
}  // namespace palp::video

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palp::video::run(palp::fuzz::ByteSource{palp::fuzz::as_bytes(data, size)});
  return 0;
}
