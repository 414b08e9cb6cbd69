#pragma once

#include <concepts>

#include "common/message/record.h"

/// One tick in one message: six small ones a tick, each with its place in the file's index, take
/// twice the room. Files only: a site records the parts.
namespace palp {

/// What a tick was given.

struct SurgeonGiven {
  TimePoint at{};
  HandReading hand;
  LinkHeard heard;
  /// That arrived; of more than these two the others have messages of their own, which come before.
  std::uint32_t samples{};
  Arrived arrived;  ///< the last one
  Arrived earlier;  ///< the one before it
};

struct PatientGiven {
  TimePoint at{};
  StageReading stage;
  ForceReading force;
  LinkHeard heard;
  std::uint32_t samples{};  ///< as the surgeon's, as are the next
  Arrived arrived;
  Arrived earlier;
};

/// A tick with what it was given.
struct SurgeonFileTick {
  TimePoint at{};
  SiteTick tick;
  bool gathered{};  ///< `given` is here; else what there is of it has messages of its own
  SurgeonGiven given;
};

struct PatientFileTick {
  TimePoint at{};
  SiteTick tick;
  bool gathered{};  ///< as the surgeon's
  PatientGiven given;
};

namespace message {

template <std::same_as<SurgeonGiven> S>
inline constexpr auto fields<S> = list({.log = "SurgeonGiven"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::hand>("hand"),
                                       field<2, &S::heard>("heard"),
                                       field<3, &S::samples>("samples"),
                                       field<4, &S::arrived>("arrived", counted<&S::samples, 0>),
                                       field<5, &S::earlier>("earlier", counted<&S::samples, 1>));

template <std::same_as<PatientGiven> S>
inline constexpr auto fields<S> = list({.log = "PatientGiven"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::stage>("stage"),
                                       field<2, &S::force>("force"),
                                       field<3, &S::heard>("heard"),
                                       field<4, &S::samples>("samples"),
                                       field<5, &S::arrived>("arrived", counted<&S::samples, 0>),
                                       field<6, &S::earlier>("earlier", counted<&S::samples, 1>));

template <std::same_as<SurgeonFileTick> S>
inline constexpr auto fields<S> = list({.log = "SurgeonTick", .one_site = true},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::tick>(""),
                                       field<19, &S::gathered>("gathered"),
                                       field<20, &S::given>("given", counted<&S::gathered, 0>));

template <std::same_as<PatientFileTick> S>
inline constexpr auto fields<S> = list({.log_patient = "PatientTick", .one_site = true},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::tick>(""),
                                       field<19, &S::gathered>("gathered"),
                                       field<20, &S::given>("given", counted<&S::gathered, 0>));

}  // namespace message
}  // namespace palp
