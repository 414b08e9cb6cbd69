#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/core/place.h"
#include "common/core/time.h"
#include "common/io/device/report_port.h"

namespace palp::surgeon {

/// What a report of a master says, or several together, in the device's own counts.
struct MasterSample {
  double position{};      ///< [counts]
  double velocity{};      ///< [counts/s]
  bool velocity_known{};  ///< else it is taken from the positions
  Place place{};          ///< on the undeformed surface
  bool pedal_held{};
  bool emergency_stop{};
  std::uint8_t answers_held{};  ///< of a study, bit 0 the first; see answer_buttons.h
  std::string_view trouble;     ///< why it is not fit, a text that lives for ever; empty: fit
  std::uint16_t sequence{};     ///< the device's own
  bool sequence_known{};
};

/// What became of a report.
enum class Taken : std::uint8_t {
  Unknown,  ///< no report of this product
  Aside,    ///< one of it, and no sign of its motor's life: a pedal beside it
  Reading
};

enum class StartOutcome : std::uint8_t { Going, Done, Failed };

/// What one product's bytes mean. Told the time. Thread: its device's.
class MasterProtocol {
 public:
  virtual ~MasterProtocol() = default;
  /// Its start begins anew; `asked`: by a person, else a device has come back by itself.
  virtual void begin(bool asked) noexcept = 0;
  /// One step of the start; `why` of a failure lives for ever.
  virtual StartOutcome start(io::ReportPort& port, TimePoint now, std::string_view& why) = 0;
  /// What a report does not say stays in `sample`.
  virtual Taken take(std::span<const std::uint8_t> report, TimePoint now, MasterSample& sample) = 0;
  /// Once a cycle. `force` [counts], finite; it and `live` false: no force, motors may be off.
  virtual io::PortFault send(io::ReportPort& port, double force, bool live, TimePoint now) = 0;
  /// Of a device that tells speeds, not places: where it is at `now`.
  /// @returns whether `sample` is whole without any report.
  virtual bool advance(TimePoint /*now*/, MasterSample& /*sample*/) { return false; }
  /// Each command is a question, and its answer the newest reading: it goes out before the look.
  [[nodiscard]] virtual bool answers() const noexcept { return false; }
  virtual void show_lamp(bool /*engaged*/) noexcept {}
  /// On the way out: no force, whatever was asked before.
  virtual void stop(io::ReportPort& port) = 0;
};

}  // namespace palp::surgeon
