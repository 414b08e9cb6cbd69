#pragma once

#include "tests/house/source.h"

/// Rules about how much one function or class may hold. Pure: text in, violations out.
namespace palp::house {

/// A table, or a class that is one list of knobs or counters, may be longer: "One list" in the
/// comment above it says so.
[[nodiscard]] Violations crowded_classes(const Source& source);
[[nodiscard]] Violations long_functions(const Source& source);

}  // namespace palp::house
