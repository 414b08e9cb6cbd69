#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/core/time.h"
#include "patient_site/devices/card_calibration.h"

namespace palp::patient {

/// Of the force cards that are known.
enum class CardKind : std::uint8_t { Usb1608, Usb1208 };

/// What sets one card apart from the others: both sample one channel without pause, 31 samples a
/// packet, about a packet a millisecond, in turn over some interfaces.
struct CardModel {
  CardKind kind{};
  std::string_view flag;  ///< as a file names it
  std::string_view name;  ///< for people
  std::uint16_t product{};
  std::size_t interfaces{};      ///< of data, beside the one of commands
  double steps{};                ///< [-], of its converter, over the whole range
  std::uint32_t same_samples{};  ///< so many equal in a row are no quiet air; 0: its steps hide it
  bool own_calibration{};        ///< its memory holds references
  std::vector<double> full_scales;  ///< [V], by the number of the range
};

[[nodiscard]] const std::vector<CardModel>& known_cards();
[[nodiscard]] const CardModel& card_model(CardKind kind);
/// nullptr: none of that name.
[[nodiscard]] const CardModel* card_named(std::string_view flag) noexcept;

/// Range of a USB-1208FS whose input is one wire against ground; all others take the difference of
/// two.
inline constexpr std::uint8_t kSingleEnded = 8;

/// [V] of a sample as it comes; `line` corrects a card that has a calibration of its own.
[[nodiscard]] double volts_of_sample(const CardModel& model,
                                     std::uint8_t range,
                                     const RawLine& line,
                                     std::uint16_t sample) noexcept;
/// Whether it is the first or the last that the converter knows.
[[nodiscard]] bool at_end(const CardModel& model,
                          std::uint8_t range,
                          std::uint16_t sample) noexcept;

/// The reports that choose its range and begin to sample `channel`, in their order.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> scan_requests(const CardModel& model,
                                                                   std::uint8_t channel,
                                                                   std::uint8_t range);

}  // namespace palp::patient
