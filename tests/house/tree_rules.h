#pragma once

#include <vector>

#include "tests/house/source.h"

/// Rules that need the whole tree. Pure. A room exists once it has a CMakeLists.txt; the files of
/// others are not judged.
namespace palp::house {

using Tree = std::vector<Source>;

/// Headers that no test stands on: neither included by a test, nor by what the tests of the same
/// room include, or by the sources of that.
[[nodiscard]] Violations untested_headers(const Tree& tree);

/// .cc files that stand in no CMakeLists.txt.
[[nodiscard]] Violations unlisted_sources(const Tree& tree);

/// Names of unnamed namespaces that two sources of one folder give alike: where builds join
/// sources, these are defined twice. Tests are never joined.
[[nodiscard]] Violations repeated_names(const Tree& tree);

/// Mentions of pages that are not here. Pages in capitals (WIRE.md) may come later than those who
/// cite them.
[[nodiscard]] Violations missing_pages(const Tree& tree);

}  // namespace palp::house
