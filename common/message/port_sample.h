#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "common/core/time.h"
#include "common/message/field.h"
#include "common/message/limits.h"

/// What the two halves of a coupling tell each other: a common part and one payload per law.
/// Everything is absolute, never an increment: a lost packet may cost freshness, never state.
namespace palp {

/// Sums of u*dt [sqrt(W)*s] and u^2/2*dt [J] since the epoch began: losses lose no account.
struct WavePayload {
  double wave_integral{};  ///< [sqrt(W) s]
  double wave_energy{};    ///< [J]
};

struct TdpaPayload {
  double energy_in{};  ///< [J], never falls: the receiver keeps the largest
};

inline constexpr double kModelDepthScale = 1e-3;  ///< [m], L0: a constant of the protocol

/// [L0]: where the second term bends. A round tip of 5 mm radius that goes in by millimetres meets
/// less new tissue than Hertz's parabola: its force grows more slowly than xi^1.5.
inline constexpr double kModelBend = 10;
inline constexpr std::size_t kModelTerms = 5;
/// [L0]: where the stiffness of a tissue is told that none of the five terms describes.
inline constexpr std::array<double, 12> kModelKnots{0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6.5, 8};
/// [s]: what tissues relax by within seconds, as shares of two times (a Prony series).
inline constexpr std::array<double, 2> kModelTimes{0.5, 2.5};

/// mmt, patient to surgeon: f = c1*xi + c2*xi^1.5/sqrt(1 + xi/10) + c3*xi^2 + c4*xi^3 + c5*xi^5
/// [N], xi = max(0, d)/L0, and the integral of a stiffness that goes in straight lines from knot to
/// knot: five numbers where they suffice, and a spline for what softens or has kinks.
struct ModelPayload {
  std::uint32_t version{};              ///< 0: none yet
  std::array<double, kModelTerms> c{};  ///< [N], each >= 0
  double surface{};                     ///< [m]: d = position - surface
  double depth_max{};                   ///< [m], deepest data behind the model
  double residual{};                    ///< [N], measured minus model, now
  /// A surface that breathes stands at surface + swing now, and at surface + swing cos(r t) +
  /// swing_quadrature sin(r t) after a time t, r = swing_rate. Nothing needs a common clock.
  double swing{};             ///< [m]
  double swing_quadrature{};  ///< [m]
  double swing_rate{};        ///< [rad/s]
  /// Tissue that relaxes answers f + sum of share (f - z), z' = (f - z)/time, never below 0: f is
  /// what it comes to.
  std::array<double, kModelTimes.size()> relaxing{};   ///< [-], the shares, each >= 0
  std::array<double, kModelKnots.size()> stiffness{};  ///< [N/m], at the knots, each >= 0
};

using CouplingPayload = std::variant<std::monostate, WavePayload, TdpaPayload, ModelPayload>;

/// What one half of a law tells the other, once per tick.
struct PortSample {
  double position{};  ///< [m], + into the tissue
  double velocity{};  ///< [m/s]
  double force{};     ///< [N]; surgeon: rendered to the hand, patient: contact, >= 0
  CouplingPayload payload;
};
static_assert(std::is_trivially_copyable_v<PortSample>, "crosses threads by copy");

/// A PortSample that arrived, with what the link knows about it.
struct Incoming {
  PortSample sample;
  std::uint64_t number{};   ///< of the datagram that first carried it
  bool fresh{};             ///< newer than all handed over before; else late or repaired
  bool repaired{};          ///< a copy that rode in a later datagram (WIRE.md)
  PeerTimePoint sent_at{};  ///< sender's line
  TimePoint arrived_at{};   ///< our line; in real time the kernel's receive stamp
};

namespace message {

template <std::same_as<WavePayload> S>
inline constexpr auto fields<S> = list({.shared = "Wave"},
                                       field<1, &S::wave_integral>("wave_integral_sqrt_w_s",
                                                                   limit(kSumMax)),
                                       field<2, &S::wave_energy>("wave_energy_j", limit(kSumMax)));

template <std::same_as<TdpaPayload> S>
inline constexpr auto fields<S> = list({.shared = "Tdpa"},
                                       field<1, &S::energy_in>("energy_in_j", limit(kSumMax)));

template <std::same_as<ModelPayload> S>
inline constexpr auto fields<S> =
    list({.shared = "Model"},
         field<1, &S::version>("version"),
         field<2, &S::c, 0>("c1_n", narrow<float>, limit(kForceMax)),
         field<3, &S::c, 1>("c2_n", narrow<float>, limit(kForceMax)),
         field<4, &S::c, 2>("c3_n", narrow<float>, limit(kForceMax)),
         field<5, &S::c, 3>("c4_n", narrow<float>, limit(kForceMax)),
         field<6, &S::c, 4>("c5_n", narrow<float>, limit(kForceMax)),
         field<7, &S::surface>("surface_m", narrow<float>, limit(kLengthMax)),
         field<8, &S::depth_max>("depth_max_m", narrow<float>, limit(kLengthMax)),
         field<9, &S::residual>("residual_n", narrow<float>, limit(kForceMax)),
         field<10, &S::swing>("swing_m", narrow<float>, limit(kLengthMax)),
         field<11, &S::swing_quadrature>("swing_quadrature_m", narrow<float>, limit(kLengthMax)),
         field<12, &S::swing_rate>("swing_rad_per_s", narrow<float>, limit(kSpeedMax)),
         field<13, &S::relaxing, 0>("relaxing_fast", narrow<float>, limit(kForceMax)),
         field<14, &S::relaxing, 1>("relaxing_slow", narrow<float>, limit(kForceMax)),
         field<15, &S::stiffness, 0>("stiffness1_n_per_m", narrow<float>, limit(kForceMax)),
         field<16, &S::stiffness, 1>("stiffness2_n_per_m", narrow<float>, limit(kForceMax)),
         field<17, &S::stiffness, 2>("stiffness3_n_per_m", narrow<float>, limit(kForceMax)),
         field<18, &S::stiffness, 3>("stiffness4_n_per_m", narrow<float>, limit(kForceMax)),
         field<19, &S::stiffness, 4>("stiffness5_n_per_m", narrow<float>, limit(kForceMax)),
         field<20, &S::stiffness, 5>("stiffness6_n_per_m", narrow<float>, limit(kForceMax)),
         field<21, &S::stiffness, 6>("stiffness7_n_per_m", narrow<float>, limit(kForceMax)),
         field<22, &S::stiffness, 7>("stiffness8_n_per_m", narrow<float>, limit(kForceMax)),
         field<23, &S::stiffness, 8>("stiffness9_n_per_m", narrow<float>, limit(kForceMax)),
         field<24, &S::stiffness, 9>("stiffness10_n_per_m", narrow<float>, limit(kForceMax)),
         field<25, &S::stiffness, 10>("stiffness11_n_per_m", narrow<float>, limit(kForceMax)),
         field<26, &S::stiffness, 11>("stiffness12_n_per_m", narrow<float>, limit(kForceMax)));

template <std::same_as<PortSample> S>
inline constexpr auto fields<S> =
    list({.wire = "Sample"},
         field<1, &S::position>("position_m", wire<float>, limit(kLengthMax)),
         field<2, &S::velocity>("velocity_m_per_s", wire<float>, limit(kSpeedMax)),
         field<3, &S::force>("force_n", wire<float>, limit(kForceMax)),
         one_of<&S::payload>("payload",
                             choice<4, WavePayload>("wave", repeated_later),
                             choice<5, TdpaPayload>("tdpa"),
                             choice<6, ModelPayload>("model", log_number<8>)));

template <std::same_as<Incoming> S>
inline constexpr auto fields<S> = list({},
                                       field<1, &S::number>("number"),
                                       field<2, &S::fresh>("fresh"),
                                       field<3, &S::repaired>("repaired"),
                                       field<4, &S::sent_at>("sent_at_ns"),
                                       field<5, &S::arrived_at>("arrived_at_ns"),
                                       spread<5, &S::sample>(""));

}  // namespace message
}  // namespace palp
