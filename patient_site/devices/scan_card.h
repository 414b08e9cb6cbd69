#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/time.h"
#include "common/io/device/report_port.h"
#include "patient_site/devices/card_model.h"
#include "patient_site/devices/device_profile.h"
#include "patient_site/devices/device_reading.h"
#include "patient_site/devices/load_check.h"

namespace palp::patient {

/// Where the transducer hangs on the card, and how it is built in.
struct CardInstallation {
  CardKind kind{};
  std::uint8_t channel{};                          ///< 0 to 7
  std::uint8_t range{};                            ///< number among the model's
  double newtons_per_volt{};                       ///< [N/V]; compression is positive; not 0
  DeviceInstallation load;                         ///< range, tare
  Duration silence{std::chrono::milliseconds{5}};  ///< longer is a fault
};

enum class CardState : std::uint8_t { Absent, Starting, Ready, Fault };
[[nodiscard]] std::string_view to_string(CardState state) noexcept;

/// Newest state of a card, as it crosses threads.
struct CardReading {
  CardState state{};
  std::string_view why;     ///< of Absent and Fault; lives for ever
  std::uint64_t number{};   ///< of readings
  std::uint64_t packets{};  ///< good ones
  std::uint64_t lost{};     ///< packets, by their own count
  std::uint64_t broken{};   ///< no packets
  std::uint32_t starts{};   ///< times it became ready
  TimePoint sampled_at{};   ///< middle of the newest reading
  double volts{};           ///< [V]
  double force{};           ///< [N], tared
  double zero{};            ///< [N], the tare
  TareNews tare;
  bool saturated{};
};

/// A card that samples one channel without pause. All samples of a cycle are averaged into one
/// reading. Told the time. Thread: its device's. The ports outlive it.
class ScanCard {
 public:
  /// Commands, then one for each interface of data.
  using Ports = std::vector<io::ReportPort*>;
  [[nodiscard]] static io::HidAddress address(const CardModel& model, int interface_number);

  ScanCard(const CardInstallation& installation, Ports ports)
      : installation_{installation},
        model_{card_model(installation.kind)},
        ports_{std::move(ports)},
        load_{installation.load} {}

  /// One period.
  CardReading cycle(const Clock& clock, const DeviceAsks& asks);
  /// On the way out: ends the scan.
  void stop();

 private:
  struct Packet {
    std::uint16_t index{};
    std::array<std::uint16_t, 31> samples{};
  };
  void reach(const Clock& clock);
  [[nodiscard]] bool start_scan();
  [[nodiscard]] bool read_calibration(const Clock& clock);
  [[nodiscard]] bool read_memory(const Clock& clock,
                                 std::uint16_t address,
                                 std::span<std::uint8_t> bytes);
  [[nodiscard]] bool drain();
  void take(const Packet& packet);
  void finish(TimePoint now);
  void vanish(std::string_view why, TimePoint now);
  void fail(std::string_view why);
  void close_all();

  CardInstallation installation_;
  const CardModel& model_;
  Ports ports_;
  LoadCheck load_;
  CardReading now_;
  RawLine line_;
  std::vector<Packet> packets_;  ///< of this cycle
  bool tried_{};
  bool index_known_{};
  std::uint16_t index_{};       ///< of the next packet
  std::size_t out_of_order_{};  ///< packets in a row that follow none
  std::uint16_t last_raw_{};
  std::uint32_t same_{};   ///< equal samples in a row
  double sum_{};           ///< [V], of the samples of this cycle
  std::uint32_t count_{};  ///< of them
  bool full_{};            ///< one of them at the end of the scale
  DeviceAsks asks_;        ///< as heard last
  std::string_view held_;  ///< why of the fault that no person has reset yet
  TimePoint heard_at_{};
  TimePoint reopen_at_{};
};

}  // namespace palp::patient
