#pragma once

#include <concepts>

#include "common/message/record.h"

/// What one tick was given, gathered into one message: five small ones a tick, each with its place
/// in the file's index, take twice the room. Files only: a site records the parts.
namespace palp {

struct SurgeonGiven {
  TimePoint at{};
  HandReading hand;
  LinkHeard heard;
  bool sampled{};   ///< a sample arrived: `arrived`, and before it those of messages of their own
  Arrived arrived;  ///< the last one
};

struct PatientGiven {
  TimePoint at{};
  StageReading stage;
  ForceReading force;
  LinkHeard heard;
  bool sampled{};   ///< as the surgeon's
  Arrived arrived;  ///< as the surgeon's
};

namespace message {

template <std::same_as<SurgeonGiven> S>
inline constexpr auto fields<S> = list({.log = "SurgeonGiven"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::hand>("hand"),
                                       field<2, &S::heard>("heard"),
                                       field<3, &S::sampled>("sampled"),
                                       field<4, &S::arrived>("arrived"));

template <std::same_as<PatientGiven> S>
inline constexpr auto fields<S> = list({.log = "PatientGiven"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::stage>("stage"),
                                       field<2, &S::force>("force"),
                                       field<3, &S::heard>("heard"),
                                       field<4, &S::sampled>("sampled"),
                                       field<5, &S::arrived>("arrived"));

}  // namespace message
}  // namespace palp
