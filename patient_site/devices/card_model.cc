#include "patient_site/devices/card_model.h"

#include <algorithm>

namespace palp::patient {
namespace {

constexpr std::uint8_t kLoadQueue = 0x13;
constexpr std::uint8_t kScan = 0x11;
constexpr std::uint8_t kScanAtOnce = 0x04;   // of a USB-1608FS
constexpr std::uint8_t kScanByQueue = 0x10;  // of a USB-1208FS: in blocks, with the queue's range
constexpr std::size_t kQueueBytes = 18;      // of a USB-1208FS
constexpr int kTwelveBits = 0x7FF;           // [counts], full scale

/// Counts about 0 V.
int twelve_bits(std::uint8_t range, std::uint16_t sample) noexcept {
  if (range != kSingleEnded) return static_cast<std::int16_t>(sample) / 16;
  // 11 bits and a half: both ends of what comes are outside.
  if (sample > 0x7FF0) return -0x800;
  if (sample > 0x7FE0) return kTwelveBits;
  return ((sample >> 3U) & 0xFFF) - 0x800;
}

}  // namespace

const std::vector<CardModel>& known_cards() {
  static const std::vector<CardModel> all{{.kind = CardKind::Usb1608,
                                           .flag = "usb-1608fs",
                                           .name = "MCC USB-1608FS",
                                           .product = 0x007D,
                                           .interfaces = 6,
                                           .steps = 65'536,
                                           .same_samples = 100,
                                           .own_calibration = true,
                                           .full_scales = {10, 5, 2.5, 2, 1.25, 1, 0.625, 0.3125}},
                                          {.kind = CardKind::Usb1208,
                                           .flag = "usb-1208fs",
                                           .name = "MCC USB-1208FS",
                                           .product = 0x0082,
                                           .interfaces = 3,
                                           .steps = 4096,
                                           .same_samples = 0,
                                           .own_calibration = false,
                                           .full_scales = {20, 10, 5, 4, 2.5, 2, 1.25, 1, 10}}};
  return all;
}

const CardModel& card_model(CardKind kind) {
  return *std::ranges::find(known_cards(), kind, &CardModel::kind);
}

const CardModel* card_named(std::string_view flag) noexcept {
  const auto& all = known_cards();
  const auto found = std::ranges::find(all, flag, &CardModel::flag);
  return found == all.end() ? nullptr : &*found;
}

double volts_of_sample(const CardModel& model,
                       std::uint8_t range,
                       const RawLine& line,
                       std::uint16_t sample) noexcept {
  if (model.kind == CardKind::Usb1608) {
    return volts_of(line.slope * sample + line.offset, card_ranges().at(range));
  }
  return twelve_bits(range, sample) * model.full_scales.at(range) / kTwelveBits;
}

bool at_end(const CardModel& model, std::uint8_t range, std::uint16_t sample) noexcept {
  if (model.kind == CardKind::Usb1608) return sample == 0 || sample == 0xFFFF;
  const int counts = twelve_bits(range, sample);
  return counts <= -0x800 || counts >= kTwelveBits;
}

std::vector<std::vector<std::uint8_t>> scan_requests(const CardModel& model,
                                                     std::uint8_t channel,
                                                     std::uint8_t range) {
  std::uint8_t input = channel;
  std::vector<std::uint8_t> queue{kLoadQueue};
  std::uint8_t options = kScanAtOnce;
  if (model.kind == CardKind::Usb1608) {
    queue.resize(1 + model.full_scales.size(), range);
  } else {
    const bool single = range == kSingleEnded;
    input = static_cast<std::uint8_t>(channel + (single ? 8 : 0));
    queue.insert(queue.end(), {1, input, static_cast<std::uint8_t>(single ? 0 : range)});
    queue.resize(kQueueBytes);
    options = kScanByQueue;
  }
  // 30,959.75 Hz, without end: about a packet a millisecond.
  return {queue, {kScan, input, input, 0, 0, 0, 0, 0, 0x43, 0x01, options}};
}

}  // namespace palp::patient
