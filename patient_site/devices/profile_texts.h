#pragma once

#include <string>
#include <string_view>

namespace palp::patient {

/// Text of a profile of patient_site/devices/profiles by its name without ending, as embedded when
/// the program was built; empty: there is none of that name.
[[nodiscard]] std::string_view profile_text(std::string_view name) noexcept;

/// All of them: "az, iai, orca".
[[nodiscard]] std::string profile_names();

}  // namespace palp::patient
