#include "video/h264_reading.h"

#include <algorithm>
#include <array>
#include <vector>

namespace palp::video {
namespace {

constexpr unsigned kNonKeySlice = 1;
constexpr unsigned kKeySlice = 5;
constexpr unsigned kParameters = 7;
constexpr std::size_t kHeadMax = 64;  // [bytes], more than a slice's head has
constexpr int kOperationsMax = 40;    // of a list

/// The bits behind a unit's first byte, without the bytes that only keep start codes away.
class Bits {
 public:
  explicit Bits(std::span<const std::byte> unit) {
    int zeros = 0;
    for (const std::byte byte : unit.subspan(std::min<std::size_t>(1, unit.size()))) {
      if (zeros >= 2 && byte == std::byte{3}) {
        zeros = 0;
        continue;
      }
      bytes_.push_back(std::to_integer<std::uint8_t>(byte));
      zeros = byte == std::byte{0} ? zeros + 1 : 0;
      if (bytes_.size() >= kHeadMax) break;
    }
  }
  /// Behind the end there are zeros.
  unsigned bit() noexcept {
    const std::size_t byte = at_ / 8;
    const unsigned value = byte < bytes_.size() ? bytes_[byte] >> (7 - at_ % 8) & 1U : 0U;
    ++at_;
    return value;
  }
  unsigned number(unsigned bits) noexcept {
    unsigned value = 0;
    for (unsigned i = 0; i < bits; ++i) value = value << 1U | bit();
    return value;
  }
  /// Exponential Golomb code.
  unsigned golomb() noexcept {
    unsigned zeros = 0;
    while (zeros < 31 && bit() == 0) ++zeros;
    return (1U << zeros) - 1 + number(zeros);
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t at_{};
};

/// Each unit between start codes.
template <class Take>
void for_each_unit(std::span<const std::byte> frame, Take take) {
  constexpr std::array kStart{std::byte{0}, std::byte{0}, std::byte{1}};
  auto begin = std::search(frame.begin(), frame.end(), kStart.begin(), kStart.end());
  while (begin != frame.end()) {
    begin += kStart.size();
    const auto end = std::search(begin, frame.end(), kStart.begin(), kStart.end());
    if (begin != end) take(std::span<const std::byte>{begin, end});
    begin = end;
  }
}

}  // namespace

std::optional<FrameNature> H264Reading::read(std::span<const std::byte> frame) {
  std::optional<FrameNature> nature;
  for_each_unit(frame, [&](std::span<const std::byte> unit) {
    const unsigned type = std::to_integer<unsigned>(unit[0]) & 31U;
    if (type == kParameters) read_parameters(unit);
    if ((type == kKeySlice || type == kNonKeySlice) && !nature) nature = read_slice(unit);
  });
  return nature;
}

void H264Reading::read_parameters(std::span<const std::byte> unit) {
  Bits bits{unit};
  (void)bits.number(24);  // profile and level
  (void)bits.golomb();    // id
  frame_num_bits_ = std::min(16U, bits.golomb() + 4);
  order_bits_ = bits.golomb() == 0 ? std::min(16U, bits.golomb() + 4) : 0;
}

std::optional<FrameNature> H264Reading::read_slice(std::span<const std::byte> unit) {
  const unsigned first = std::to_integer<unsigned>(unit[0]);
  FrameNature nature;
  nature.key = (first & 31U) == kKeySlice;
  Bits bits{unit};
  (void)bits.golomb();  // first macroblock
  const bool predicted = bits.golomb() % 5 == 0;
  (void)bits.golomb();  // picture parameter set
  nature.frame_num = static_cast<int>(bits.number(frame_num_bits_));
  nature.marked_frame_num = nature.frame_num;
  if (nature.key) key_id_ = static_cast<int>(bits.golomb());
  nature.key_id = key_id_;
  if (order_bits_ > 0) (void)bits.number(order_bits_);
  if (predicted) {
    if (bits.bit() != 0) (void)bits.golomb();  // another number of references
    if (bits.bit() != 0) {
      for (int i = 0; i < kOperationsMax; ++i) {  // of the list of references
        const unsigned operation = bits.golomb();
        if (operation == 3) break;
        (void)bits.golomb();
        if (operation == 2) nature.refers_to_long_term = true;
      }
    }
  }
  if ((first >> 5U & 3U) == 0) return nature;  // nothing refers to it
  if (nature.key) {
    (void)bits.bit();
    nature.marks = bits.bit() != 0;
    return nature;
  }
  if (bits.bit() == 0) return nature;
  for (int i = 0; i < kOperationsMax; ++i) {  // of the marks of references
    const unsigned operation = bits.golomb();
    if (operation == 0) break;
    const unsigned back = operation == 1 || operation == 3 ? bits.golomb() : 0;
    if (operation == 2 || operation == 4) (void)bits.golomb();
    if (operation == 3 || operation == 6) (void)bits.golomb();
    if (operation != 3 && operation != 6) continue;
    nature.marks = true;
    const unsigned mask = (1U << frame_num_bits_) - 1U;
    const unsigned number = static_cast<unsigned>(nature.frame_num);
    const unsigned marked = operation == 3 ? number - back - 1U : number;
    nature.marked_frame_num = static_cast<int>(marked & mask);
  }
  return nature;
}

}  // namespace palp::video
