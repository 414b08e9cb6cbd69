#pragma once

#include <string_view>

namespace palp::patient {

/// Text of a table of patient_site/phantoms by its name without `.csv`, as embedded when the
/// program was built. An unknown name is our bug.
[[nodiscard]] std::string_view phantom_table(std::string_view name) noexcept;

}  // namespace palp::patient
