#pragma once

#include <cstdint>
#include <initializer_list>

#include "common/io/device/modbus_port.h"
#include "surgeon_site/devices/answer_buttons.h"
#include "surgeon_site/devices/master_protocol.h"

namespace palp::surgeon {

/// An Iris ORCA linear motor as a haptic master: its shaft is the handle, its force is commanded
/// and its place read in one request over Modbus (RegisterReports). The drive's own watchdog takes
/// the force away 50 ms after the last request, its own ceiling bounds it. It has no button: a
/// pedal on USB stands beside it. Counts are um and mN. Thread: its device's.
class ShaftMotor final : public MasterProtocol {
 public:
  static constexpr double kPositionUnit = 1e-6;   ///< [m]
  static constexpr double kForceUnit = 1e-3;      ///< [N]
  static constexpr std::uint16_t kPlaceAt = 342;  ///< register of its place, 2 words
  static constexpr char kParity = 'E';
  static constexpr Duration kReplyDelay = std::chrono::milliseconds{1};
  /// What a command and its answer take on this line.
  [[nodiscard]] static Duration time_of_exchange(const io::ModbusAddress& line) noexcept;
  /// Where a pedal's report says that it is held.
  struct Pedal {
    std::size_t byte{};
    std::uint8_t mask{1};
  };
  /// `force_max` [N], above 0. `answers`: bits of the pedal's report, from its byte 0 on.
  ShaftMotor(double force_max, const Pedal& pedal, AnswerButtons answers = AnswerButtons{}) noexcept
      : force_max_{force_max}, pedal_{pedal}, answers_{std::move(answers)} {}

  void begin(bool asked) noexcept override;
  StartOutcome start(io::ReportPort& port, TimePoint now, std::string_view& why) override;
  Taken take(std::span<const std::uint8_t> report, TimePoint now, MasterSample& sample) override;
  io::PortFault send(io::ReportPort& port, double force, bool live, TimePoint now) override;
  [[nodiscard]] bool answers() const noexcept override { return true; }
  void stop(io::ReportPort& port) override;

 private:
  enum class Step : std::uint8_t { Sleep, Look, Clear, Watchdog, Ceiling, Mode, Wait, Done };
  [[nodiscard]] static io::PortFault ask(io::ReportPort& port,
                                         std::uint8_t kind,
                                         std::initializer_list<std::uint16_t> words);

  double force_max_;  ///< [N]
  Pedal pedal_;
  AnswerButtons answers_;
  Step step_{};
  bool asked_{};
  bool errors_known_{};
  bool mode_known_{};
  bool place_known_{};
  std::uint16_t errors_{};
  std::uint16_t mode_{};
  std::uint32_t sent_{};
};

}  // namespace palp::surgeon
