#pragma once

#include <array>

#include "surgeon_site/devices/answer_buttons.h"
#include "surgeon_site/devices/master_protocol.h"

namespace palp::surgeon {

/// A cap on springs with six axes and no motor: its deflection is a speed, of the indentation and
/// of the place. It feels nothing. A cap at rest is silent; one that is deflected and silent stands
/// still after 100 ms. Its counts are m already. Thread: its device's.
class SpaceMouse final : public MasterProtocol {
 public:
  struct Rates {
    double speed_max{20e-3};       ///< [m/s], along the normal at full deflection
    double side_speed_max{50e-3};  ///< [m/s], along the surface
    double travel_min{-60e-3};     ///< [m]
    double travel_max{20e-3};      ///< [m]
    double reach{0.2};             ///< [m], along the surface, either way
    double begin{-10e-3};          ///< [m], where the hand is at the start
    int pedal_button{};            ///< 0 to 15
  };
  static constexpr double kPositionUnit = 1;  ///< [m]
  /// `answers`: 0 to 15, of its buttons.
  explicit SpaceMouse(const Rates& rates, AnswerButtons answers = AnswerButtons{}) noexcept
      : rates_{rates}, answers_{std::move(answers)} {}
  /// Of all models that are known, in the order of their worth.
  [[nodiscard]] static std::array<io::HidAddress, 8> addresses();

  void begin(bool asked) noexcept override;
  StartOutcome start(io::ReportPort& port, TimePoint now, std::string_view& why) override;
  Taken take(std::span<const std::uint8_t> report, TimePoint now, MasterSample& sample) override;
  io::PortFault send(io::ReportPort& port, double force, bool live, TimePoint now) override;
  bool advance(TimePoint now, MasterSample& sample) override;
  void stop(io::ReportPort& /*port*/) override {}

 private:
  Rates rates_;
  AnswerButtons answers_;
  std::array<double, 3> deflection_{};  ///< [-], -1 to 1, x, y and z of the cap
  double position_{};                   ///< [m]
  Place place_{};
  bool pedal_held_{};
  std::uint8_t answers_held_{};  ///< as in MasterSample
  bool stepped_{};
  TimePoint heard_at_{};
  TimePoint stepped_at_{};
};

}  // namespace palp::surgeon
