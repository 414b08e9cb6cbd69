#pragma once

#include "surgeon_site/devices/answer_buttons.h"
#include "surgeon_site/devices/master_protocol.h"

namespace palp::surgeon {

/// An OpenFFBoard of one axis: a HID device of class PID. Its position counts +-32767 over its
/// configured rotation, its force +-32767 over its configured torque. The force is an effect that
/// ends by itself after 100 ms and is started again long before, so that a dead host stops the
/// motor. A still handle reports 10 times a second. Thread: its device's.
class ForceFeedbackBoard final : public MasterProtocol {
 public:
  /// `pedal_button`: 0 to 63, of its buttons; `answers` likewise.
  explicit ForceFeedbackBoard(int pedal_button, AnswerButtons answers = AnswerButtons{}) noexcept
      : pedal_button_{pedal_button}, answers_{std::move(answers)} {}
  [[nodiscard]] static io::HidAddress address();

  void begin(bool asked) noexcept override;
  StartOutcome start(io::ReportPort& port, TimePoint now, std::string_view& why) override;
  Taken take(std::span<const std::uint8_t> report, TimePoint now, MasterSample& sample) override;
  io::PortFault send(io::ReportPort& port, double force, bool live, TimePoint now) override;
  void stop(io::ReportPort& port) override;

 private:
  enum class Step : std::uint8_t { Reset, Enable, Gain, Create, Load, Set, Start, Ask, Wait, Done };
  [[nodiscard]] StartOutcome load(io::ReportPort& port, std::string_view& why);
  [[nodiscard]] io::PortFault set_effect(io::ReportPort& port) const;
  [[nodiscard]] io::PortFault start_effect(io::ReportPort& port, TimePoint now);

  int pedal_button_;
  AnswerButtons answers_;
  Step step_{};
  std::uint8_t block_{};
  int resets_{};  ///< in this start, of a full pool
  bool state_known_{};
  bool axes_known_{};
  TimePoint effect_at_{};  ///< last begun
};

}  // namespace palp::surgeon
